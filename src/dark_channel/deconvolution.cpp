#include "dark_channel/deconvolution.hpp"

#include <algorithm>
#include <cmath>

#include "dark_channel/latent_estimation.hpp"

namespace fast_edi {
namespace {

/// Penalties as multiples of omega: the first one takes away differences below a half (of 1), the
/// last one hardly any.
constexpr double kFirstPenalty = 1.0;
constexpr double kLastPenalty = 1024.0;
constexpr double kPenaltyGrowth = 2.0;

void shrink(cv::Mat1f& differences, double by) {
  const auto step = static_cast<float>(by);
  for (float& difference : differences) {
    difference = std::copysign(std::max(std::abs(difference) - step, 0.0F), difference);
  }
}

}  // namespace

cv::Mat1f deconvolve(const cv::Mat1f& blurry, const cv::Mat1f& kernel, double omega) {
  const LatentSolver solver(blurry, kernel);
  cv::Mat1f latent = blurry;
  for (double alpha = kFirstPenalty * omega; alpha <= kLastPenalty * omega;
       alpha *= kPenaltyGrowth) {
    Gradient gradient = gradientOf(latent);
    shrink(gradient.x, omega / (2.0 * alpha));
    shrink(gradient.y, omega / (2.0 * alpha));
    latent = solver.solve(alpha * adjointGradient(gradient), alpha, 0.0);
  }
  return latent;
}

}  // namespace fast_edi
