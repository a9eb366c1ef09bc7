/// \file
/// Deconvolution with a known kernel, by total variation (Y. Wang, J. Yang, W. Yin, Y. Zhang, SIAM
/// Journal on Imaging Sciences 1(3), 2008):
///
///     min_I  |I * k - B|^2 + omega (|dI/dx|_1 + |dI/dy|_1)
///
/// by half-quadratic splitting as in latent_estimation.hpp, with g = sign(dI) max(|dI| - omega / (2
/// alpha), 0).
#pragma once

#include <opencv2/core.hpp>

namespace fast_edi {

/// \param blurry B, periodic, 0 to 1
/// \param kernel k, whose sum is 1
/// \param omega weight of the total variation, > 0
cv::Mat1f deconvolve(const cv::Mat1f& blurry, const cv::Mat1f& kernel, double omega);

}  // namespace fast_edi
