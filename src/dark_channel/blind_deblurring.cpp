#include "dark_channel/blind_deblurring.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "dark_channel/deconvolution.hpp"
#include "dark_channel/kernel_estimation.hpp"
#include "dark_channel/periodic_image.hpp"
#include "fast_edi/base/sensor_size.hpp"

namespace fast_edi {
namespace {

constexpr double kWhiteDn = 255.0;
constexpr int kCoarsestKernelPx = 5;
constexpr double kWeightDecay = 1.1;
constexpr double kSmallestWeight = 1e-4;

void require(bool holds, const std::string& what) {
  if (!holds) {
    throw std::invalid_argument("dark channel: expected " + what);
  }
}

/// Sides of the kernel from the coarsest scale to the finest.
std::vector<int> kernelSides(int finest) {
  std::vector<int> sides = {finest};
  for (double side = finest / std::sqrt(2.0); side >= kCoarsestKernelPx; side /= std::sqrt(2.0)) {
    const int rounded = static_cast<int>(std::ceil(side));
    sides.push_back(rounded + (rounded % 2 == 0 ? 1 : 0));
  }
  std::reverse(sides.begin(), sides.end());
  return sides;
}

/// Two neighbours in the middle: a single one would be the solution without any blur.
cv::Mat1f firstKernel(int side) {
  constexpr float kHalf = 0.5F;
  cv::Mat1f kernel(side, side, 0.0F);
  kernel(side / 2, side / 2) = kHalf;
  kernel(side / 2, side / 2 - 1) = kHalf;
  return kernel;
}

cv::Mat1f reduced(const cv::Mat1f& image, double factor) {
  cv::Mat1f small;
  cv::resize(image, small, {}, factor, factor, cv::INTER_AREA);
  return small;
}

/// Weights that become smaller from step to step.
LatentWeights decayed(LatentWeights weights) {
  const auto smaller = [](double weight) {
    return std::max(weight / kWeightDecay, std::min(weight, kSmallestWeight));
  };
  weights.dark = smaller(weights.dark);
  weights.gradient = smaller(weights.gradient);
  return weights;
}

}  // namespace

void BlindDeblurringOptions::validate() const {
  require(kernel_px >= kMinKernelPx && kernel_px % 2 == 1,
          "a kernel with an odd side of at least " + std::to_string(kMinKernelPx) + " px, got " +
              std::to_string(kernel_px));
  require(weights.dark >= 0.0, "a weight of the dark channel of at least 0");
  require(weights.gradient > 0.0, "a weight of the gradient above 0");
  require(kernel_weight > 0.0, "a weight of the kernel above 0");
  require(deconvolution_weight > 0.0, "a weight of the deconvolution above 0");
  require(weights.patch_px >= 1 && iterations >= 1,
          "at least one iteration and one pixel of patch");
}

BlindDeblurringResult deblurBlindly(const cv::Mat& blurry, const BlindDeblurringOptions& options,
                                    const std::function<void(double)>& progress) {
  options.validate();
  require(blurry.type() == CV_8UC1, "an image of one channel of 8 bits");
  require(std::min(blurry.cols, blurry.rows) > options.kernel_px,
          "an image larger than the kernel of " + std::to_string(options.kernel_px) +
              " px, got one of " + sizeText(blurry.cols, blurry.rows));
  cv::Mat1f image;
  blurry.convertTo(image, CV_32F, 1.0 / kWhiteDn);

  const std::vector<int> sides = kernelSides(options.kernel_px);
  // Work goes with the number of pixels, which doubles from scale to scale.
  const double all_work = std::pow(2.0, static_cast<double>(sides.size())) - 1.0;
  double work = 0.0;
  LatentWeights weights = options.weights;
  cv::Mat1f kernel = firstKernel(sides.front());
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const double factor = std::pow(0.5, 0.5 * static_cast<double>(sides.size() - 1 - i));
    const cv::Mat1f scaled = i + 1 < sides.size() ? reduced(image, factor) : image;
    const cv::Mat1f periodic = periodicImage(scaled, sides[i]);
    if (i > 0) {
      kernel = plausibleKernel(enlargedKernel(kernel, sides[i]));
    }
    for (int iteration = 0; iteration < options.iterations; ++iteration) {
      const cv::Mat1f latent = estimateLatent(periodic, kernel, weights);
      kernel = estimateKernel(latent, periodic, scaled.size(), options.kernel_weight, sides[i]);
      weights = decayed(weights);
      work += std::pow(2.0, static_cast<double>(i)) / options.iterations;
      progress(work / all_work);
    }
  }

  const cv::Mat1f latent =
      deconvolve(periodicImage(image, options.kernel_px), kernel, options.deconvolution_weight);
  BlindDeblurringResult result;
  latent(cv::Rect({0, 0}, image.size())).convertTo(result.image, CV_8U, kWhiteDn);
  result.kernel = kernel;
  return result;
}

}  // namespace fast_edi
