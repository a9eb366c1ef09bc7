#include "dark_channel/kernel_estimation.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "dark_channel/fourier.hpp"

namespace fast_edi {
namespace {

constexpr double kSmallestShareOfPeak = 0.05;
constexpr double kSmallestPart = 0.1;

/// Gradients between pixels inside; elsewhere 0.
Gradient gradientInside(const cv::Mat1f& image, cv::Size inside) {
  Gradient gradient = gradientOf(image);
  for (cv::Mat1f* part : {&gradient.x, &gradient.y}) {
    part->colRange(inside.width - 1, part->cols).setTo(0.0F);
    part->rowRange(inside.height - 1, part->rows).setTo(0.0F);
  }
  return gradient;
}

cv::Mat1f normalised(const cv::Mat1f& kernel) {
  return kernel / cv::sum(kernel)[0];
}

/// Keeps at least the part with the largest sum.
void removeSmallParts(cv::Mat1f& kernel) {
  constexpr int kConnectivity = 8;
  cv::Mat1i labels;
  const int count = cv::connectedComponents(kernel > 0.0F, labels, kConnectivity, CV_32S);
  std::vector<float> sums(static_cast<std::size_t>(count), 0.0F);
  for (int y = 0; y < kernel.rows; ++y) {
    for (int x = 0; x < kernel.cols; ++x) {
      sums[static_cast<std::size_t>(labels(y, x))] += kernel(y, x);
    }
  }
  const double least = std::min<double>(kSmallestPart * cv::sum(kernel)[0],
                                        *std::max_element(sums.begin(), sums.end()));
  for (int label = 1; label < count; ++label) {
    if (sums[static_cast<std::size_t>(label)] < least) {
      kernel.setTo(0.0F, labels == label);
    }
  }
}

/// Moves the centroid to the centre, but nothing that counts over the edge.
cv::Mat1f centred(const cv::Mat1f& kernel) {
  const cv::Moments moments = cv::moments(kernel);
  const cv::Point centre(kernel.cols / 2, kernel.rows / 2);
  const cv::Rect used = cv::boundingRect(kernel > 0.0F);
  const auto limited = [](double shift, int before, int after) {
    return std::max(-before, std::min(after, cvRound(shift)));
  };
  const cv::Point shift(
      limited(centre.x - moments.m10 / moments.m00, used.x, kernel.cols - used.x - used.width),
      limited(centre.y - moments.m01 / moments.m00, used.y, kernel.rows - used.y - used.height));
  cv::Mat1f result(kernel.size(), 0.0F);
  kernel(used).copyTo(result(used + shift));
  return result;
}

}  // namespace

cv::Mat1f estimateKernel(const cv::Mat1f& latent, const cv::Mat1f& blurry, cv::Size inside,
                         double gamma, int size_px) {
  const Gradient sharp = gradientInside(latent, inside);
  const Gradient blurred = gradientInside(blurry, inside);
  const Spectrum sharp_x = forwardTransform(sharp.x);
  const Spectrum sharp_y = forwardTransform(sharp.y);
  Spectrum spectrum = conjugateProduct(sharp_x, forwardTransform(blurred.x)) +
                      conjugateProduct(sharp_y, forwardTransform(blurred.y));
  const cv::Mat1f power = powerOf(sharp_x) + powerOf(sharp_y) + gamma;
  for (int y = 0; y < spectrum.rows; ++y) {
    for (int x = 0; x < spectrum.cols; ++x) {
      spectrum(y, x) *= 1.0F / power(y, x);
    }
  }
  const cv::Mat1f everywhere = inverseTransform(spectrum);
  const cv::Size size = everywhere.size();
  cv::Mat1f kernel(size_px, size_px);
  for (int y = 0; y < size_px; ++y) {
    for (int x = 0; x < size_px; ++x) {
      kernel(y, x) = everywhere((y - size_px / 2 + size.height) % size.height,
                                (x - size_px / 2 + size.width) % size.width);
    }
  }
  return plausibleKernel(kernel);
}

cv::Mat1f plausibleKernel(const cv::Mat1f& estimate) {
  double peak = 0.0;
  cv::minMaxLoc(estimate, nullptr, &peak);
  if (!(peak > 0.0)) {
    cv::Mat1f point(estimate.size(), 0.0F);
    point(estimate.rows / 2, estimate.cols / 2) = 1.0F;
    return point;
  }
  cv::Mat1f kernel = estimate.clone();
  kernel.setTo(0.0F, kernel < kSmallestShareOfPeak * peak);
  removeSmallParts(kernel);
  return centred(normalised(kernel));
}

cv::Mat1f enlargedKernel(const cv::Mat1f& kernel, int size_px) {
  cv::Mat1f larger;
  cv::resize(kernel, larger, {size_px, size_px}, 0.0, 0.0, cv::INTER_LINEAR);
  return normalised(larger);
}

}  // namespace fast_edi
