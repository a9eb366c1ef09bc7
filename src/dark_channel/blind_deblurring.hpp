/// \file
/// Blind deblurring of a single image, one kernel for all of it, by the dark channel prior (J. Pan,
/// D. Sun, H. Pfister, M.-H. Yang, *Blind Image Deblurring Using Dark Channel Prior*, CVPR 2016):
///
///     B = I * k + noise
///
/// From coarse to fine, each scale 1/sqrt(2) of the next one: latent image (latent_estimation.hpp)
/// and kernel (kernel_estimation.hpp) are estimated in turns, and lambda and mu become smaller
/// by 1.1 each time. The image is deconvolved with the last kernel (deconvolution.hpp).
///
/// The prior: blur mixes the darkest pixel of a neighbourhood with brighter ones, so the dark
/// channel of a sharp image has more zeros. Where the blur differs over the image, or nothing is
/// dark, it does not hold.
#pragma once

#include <functional>

#include <opencv2/core.hpp>

#include "dark_channel/latent_estimation.hpp"

namespace fast_edi {

/// Weights are the paper's, for intensities from 0 to 1. It gives no kernel size: that follows the
/// blur.
struct BlindDeblurringOptions {
  int kernel_px = 25;  ///< side of the kernel, odd; must hold the blur
  LatentWeights weights;
  double kernel_weight = 2.0;           ///< gamma
  int iterations = 5;                   ///< latent image and kernel, at each scale
  double deconvolution_weight = 0.002;  ///< omega of deconvolution.hpp

  /// \throws std::invalid_argument naming what is out of range
  void validate() const;
};
constexpr int kMinKernelPx = 3;

struct BlindDeblurringResult {
  cv::Mat image;     ///< CV_8UC1
  cv::Mat1f kernel;  ///< sum 1, centroid in the centre
};

/// \param blurry CV_8UC1, larger than the kernel
/// \param progress called with 0 to 1
/// \throws std::invalid_argument for an image of another type or too small, or options out of range
BlindDeblurringResult deblurBlindly(const cv::Mat& blurry, const BlindDeblurringOptions& options,
                                    const std::function<void(double)>& progress);

}  // namespace fast_edi
