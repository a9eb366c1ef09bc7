/// \file
/// The kernel for a known latent image (Pan et al., CVPR 2016, section 4.3):
///
///     min_k  |grad I * k - grad B|^2 + gamma |k|^2
///     F(k) = sum_{x, y} conj(F(dI)) F(dB) / (sum_{x, y} |F(dI)|^2 + gamma)
///
/// after which k is what a blur can be: not negative, of sum 1, and without noise far from its
/// path.
#pragma once

#include <opencv2/core.hpp>

namespace fast_edi {

/// \param latent, \p blurry periodic, of the same size
/// \param inside where both show the scene; gradients elsewhere do not count
/// \param gamma weight of |k|^2, > 0
/// \param size_px side of the kernel, odd
cv::Mat1f estimateKernel(const cv::Mat1f& latent, const cv::Mat1f& blurry, cv::Size inside,
                         double gamma, int size_px);

/// Makes a kernel of \p estimate: what is negative or below a twentieth of the largest value
/// becomes 0, and so do 8-connected parts that sum up to less than a tenth of all (the largest one
/// stays). The sum is 1, and the centroid is within half a pixel of the centre (or as near as the
/// kernel's size allows): a shift of kernel and image against each other leaves the blurry image as
/// it is. Nothing above 0: a single 1 in the centre.
cv::Mat1f plausibleKernel(const cv::Mat1f& estimate);

/// \p kernel enlarged to \p size_px, sum 1.
cv::Mat1f enlargedKernel(const cv::Mat1f& kernel, int size_px);

}  // namespace fast_edi
