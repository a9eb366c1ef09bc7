#include "dark_channel/latent_estimation.hpp"

#include <opencv2/imgproc.hpp>

namespace fast_edi {
namespace {

constexpr double kFirstPenaltyFactor = 2.0;
constexpr double kPenaltyGrowth = 2.0;

}  // namespace

LatentSolver::LatentSolver(const cv::Mat1f& blurry, const cv::Mat1f& kernel)
    : gradient_power_(gradientPower(blurry.size())) {
  const Spectrum transfer = transferFunction(kernel, blurry.size());
  data_ = conjugateProduct(transfer, forwardTransform(blurry));
  kernel_power_ = powerOf(transfer);
}

cv::Mat1f LatentSolver::solve(const cv::Mat1f& pulled, double alpha, double beta) const {
  Spectrum spectrum = forwardTransform(pulled);
  const auto gradient_weight = static_cast<float>(alpha);
  const auto image_weight = static_cast<float>(beta);
  for (int y = 0; y < spectrum.rows; ++y) {
    for (int x = 0; x < spectrum.cols; ++x) {
      const float power =
          kernel_power_(y, x) + gradient_weight * gradient_power_(y, x) + image_weight;
      spectrum(y, x) = (spectrum(y, x) + data_(y, x)) * (1.0F / power);
    }
  }
  return inverseTransform(spectrum);
}

cv::Mat1f withDarkChannelThresholded(const cv::Mat1f& image, int patch_px, double threshold) {
  // A pixel is the darkest of some neighbourhood exactly where opening (the largest of the minima
  // around) leaves it as it is.
  const cv::Mat patch = cv::getStructuringElement(cv::MORPH_RECT, {patch_px, patch_px});
  cv::Mat1f opened;
  cv::morphologyEx(image, opened, cv::MORPH_OPEN, patch);
  cv::Mat1f result = image.clone();
  result.setTo(0.0F, (opened == image) & (image.mul(image) < threshold));
  return result;
}

void thresholdGradient(Gradient& gradient, double threshold) {
  const auto smallest = static_cast<float>(threshold);
  for (int y = 0; y < gradient.x.rows; ++y) {
    float* dx = gradient.x[y];
    float* dy = gradient.y[y];
    for (int x = 0; x < gradient.x.cols; ++x) {
      if (dx[x] * dx[x] + dy[x] * dy[x] < smallest) {
        dx[x] = 0.0F;
        dy[x] = 0.0F;
      }
    }
  }
}

cv::Mat1f estimateLatent(const cv::Mat1f& blurry, const cv::Mat1f& kernel,
                         const LatentWeights& weights) {
  const LatentSolver solver(blurry, kernel);
  cv::Mat1f latent = blurry;
  const auto sweep_gradient = [&](const cv::Mat1f& target, double beta) {
    for (double alpha = kFirstPenaltyFactor * weights.gradient;
         alpha < weights.gradient_penalty_max; alpha *= kPenaltyGrowth) {
      Gradient gradient = gradientOf(latent);
      thresholdGradient(gradient, weights.gradient / alpha);
      latent = solver.solve(alpha * adjointGradient(gradient) + beta * target, alpha, beta);
    }
  };
  if (weights.dark <= 0.0) {
    sweep_gradient(blurry, 0.0);
  }
  for (double beta = kFirstPenaltyFactor * weights.dark;
       weights.dark > 0.0 && beta < weights.dark_penalty_max; beta *= kPenaltyGrowth) {
    sweep_gradient(withDarkChannelThresholded(latent, weights.patch_px, weights.dark / beta), beta);
  }
  return latent;
}

}  // namespace fast_edi
