/// \file
/// The latent image for a known kernel, by the L0 norms of its gradient and of its dark channel
/// (J. Pan, D. Sun, H. Pfister, M.-H. Yang, *Blind Image Deblurring Using Dark Channel Prior*, CVPR
/// 2016, sections 4.1 and 4.2):
///
///     min_I  |I * k - B|^2 + mu |grad I|_0 + lambda |D(I)|_0,   D(I)(x) = min_{y in N(x)} I(y)
///
/// by half-quadratic splitting. With g for the gradient, and t for the image whose dark channel is
/// u (t = I but at the darkest pixel of each neighbourhood, where it is u),
///
///     min  |I * k - B|^2 + alpha |grad I - g|^2 + beta |I - t|^2 + mu |g|_0 + lambda |u|_0
///
/// is solved in turns:
///
///     u = D(I) where D(I)^2 >= lambda / beta, else 0
///     g = grad I where |grad I|^2 >= mu / alpha, else 0
///     F(I) = (conj(F(k)) F(B) + alpha F(grad^T g) + beta F(t))
///            / (|F(k)|^2 + alpha |F(grad)|^2 + beta)
///
/// with beta from 2 lambda to beta_max, and for each of its values alpha from 2 mu to alpha_max,
/// both doubled each time. Intensities are 0 to 1.
#pragma once

#include <opencv2/core.hpp>

#include "dark_channel/fourier.hpp"

namespace fast_edi {

struct LatentWeights {
  double dark = 0.004;      ///< lambda; 0: without dark channel
  double gradient = 0.004;  ///< mu, > 0
  int patch_px = 35;        ///< side of N(x)
  double dark_penalty_max = 8.0;
  double gradient_penalty_max = 1e5;
};

/// \param blurry B, periodic
/// \param kernel k, whose sum is 1
cv::Mat1f estimateLatent(const cv::Mat1f& blurry, const cv::Mat1f& kernel,
                         const LatentWeights& weights);

/// t for u: \p image, but 0 at each pixel that is the darkest of some neighbourhood (of \p patch_px
/// by \p patch_px pixels, cut off at the image's edges) and whose square is below \p threshold.
cv::Mat1f withDarkChannelThresholded(const cv::Mat1f& image, int patch_px, double threshold);

/// g: \p gradient, but 0 where its square is below \p threshold.
void thresholdGradient(Gradient& gradient, double threshold);

/// The last of the equations above. What does not change with the penalties is kept.
class LatentSolver {
 public:
  LatentSolver(const cv::Mat1f& blurry, const cv::Mat1f& kernel);

  /// \param pulled alpha grad^T g + beta t
  cv::Mat1f solve(const cv::Mat1f& pulled, double alpha, double beta) const;

 private:
  Spectrum data_;             ///< conj(F(k)) F(B)
  cv::Mat1f kernel_power_;    ///< |F(k)|^2
  cv::Mat1f gradient_power_;  ///< |F(grad)|^2
};

}  // namespace fast_edi
