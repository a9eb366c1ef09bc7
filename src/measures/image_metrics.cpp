#include "measures/image_metrics.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include <opencv2/imgproc.hpp>
#ifdef FAST_EDI_HAVE_OPENCV_QUALITY
#include <opencv2/quality/qualityssim.hpp>
#endif

#include "measures/capability.hpp"

namespace fast_edi {
namespace {

void requirePair(const cv::Mat& image, const cv::Mat& truth, const std::string& what) {
  requireMono8(image, what);
  requireMono8(truth, what + " (truth)");
  if (image.size() != truth.size()) {
    throw std::invalid_argument(what + ": image is " + std::to_string(image.cols) + "x" +
                                std::to_string(image.rows) + ", truth " +
                                std::to_string(truth.cols) + "x" + std::to_string(truth.rows) +
                                "; expected the same size");
  }
}

void requireThreeByThree(const cv::Mat& image, const std::string& what) {
  requireMono8(image, what);
  if (image.cols < 3 || image.rows < 3) {
    throw std::invalid_argument(what + ": expected at least 3x3 pixels");
  }
}

cv::Mat withoutBorder(const cv::Mat& image) {
  return image(cv::Rect(1, 1, image.cols - 2, image.rows - 2));
}

}  // namespace

void requireMono8(const cv::Mat& image, const std::string& what) {
  if (image.empty()) {
    throw std::invalid_argument(what + ": empty image");
  }
  if (image.type() != CV_8UC1) {
    throw std::invalid_argument(what + ": expected one channel of 8 bits (CV_8UC1), got type " +
                                std::to_string(image.type()));
  }
}

double psnr(const cv::Mat& image, const cv::Mat& truth) {
  requirePair(image, truth, "PSNR");
  constexpr double kPeakDn = 255.0;
  const double squared_error = cv::norm(image, truth, cv::NORM_L2SQR);
  if (squared_error == 0.0) {
    return kMaxPsnrDb;
  }
  const double mean_squared_error = squared_error / static_cast<double>(image.total());
  return std::min(kMaxPsnrDb, 10.0 * std::log10(kPeakDn * kPeakDn / mean_squared_error));
}

double ssim(const cv::Mat& image, const cv::Mat& truth) {
  requirePair(image, truth, "SSIM");
  require(OptionalLibrary::kOpencvQuality, "SSIM");
#ifdef FAST_EDI_HAVE_OPENCV_QUALITY
  return cv::quality::QualitySSIM::compute(truth, image, cv::noArray())[0];
#else
  return 0.0;
#endif
}

double noiseSigma(const cv::Mat& image) {
  requireThreeByThree(image, "noise estimate");
  const cv::Mat kernel = (cv::Mat_<float>(3, 3) << 1, -2, 1, -2, 4, -2, 1, -2, 1);
  constexpr double kKernelNorm = 6.0;           // square root of the sum of squared weights
  constexpr double kMedianOfGaussian = 0.6745;  // of the absolute value, in standard deviations
  cv::Mat response;
  cv::filter2D(image, response, CV_32F, kernel);
  const cv::Mat inner = withoutBorder(response);
  std::vector<float> magnitudes;
  magnitudes.reserve(inner.total());
  for (int y = 0; y < inner.rows; ++y) {
    const float* row = inner.ptr<float>(y);
    std::transform(row, row + inner.cols, std::back_inserter(magnitudes),
                   [](float value) { return std::abs(value); });
  }
  const auto middle = magnitudes.begin() + static_cast<std::ptrdiff_t>(magnitudes.size() / 2);
  std::nth_element(magnitudes.begin(), middle, magnitudes.end());
  return *middle / (kKernelNorm * kMedianOfGaussian);
}

Sharpness sharpness(const cv::Mat& image) {
  requireThreeByThree(image, "sharpness");
  constexpr double kSobelScale = 1.0 / 8.0;
  constexpr double kNoiseShare = 2.0 * 12.0 / 64.0;
  cv::Mat gx;
  cv::Mat gy;
  cv::Sobel(image, gx, CV_32F, 1, 0, 3, kSobelScale);
  cv::Sobel(image, gy, CV_32F, 0, 1, 3, kSobelScale);
  const cv::Mat inner_gx = withoutBorder(gx);
  const cv::Mat inner_gy = withoutBorder(gy);

  Sharpness result;
  result.tenengrad = (cv::norm(inner_gx, cv::NORM_L2SQR) + cv::norm(inner_gy, cv::NORM_L2SQR)) /
                     static_cast<double>(inner_gx.total());
  result.noise_sigma_dn = noiseSigma(image);
  result.tenengrad_above_noise =
      std::max(0.0, result.tenengrad - kNoiseShare * result.noise_sigma_dn * result.noise_sigma_dn);
  return result;
}

}  // namespace fast_edi
