/// \file
/// Picture quality against known truth, and sharpness without it.
///
/// All images are CV_8UC1. Functions throw std::invalid_argument for another type, an empty image
/// or two images of different size.
#pragma once

#include <string>

#include <opencv2/core.hpp>

namespace fast_edi {

/// Throws std::invalid_argument "<what>: ..." unless \p image is non-empty and CV_8UC1.
void requireMono8(const cv::Mat& image, const std::string& what);

/// Peak signal-to-noise ratio [dB], peak 255: 10 log10(255^2 / MSE). Identical images give
/// kMaxPsnrDb instead of infinity, so that means stay finite.
double psnr(const cv::Mat& image, const cv::Mat& truth);
/// What psnr() returns for identical images [dB]: well above that of 8-bit rounding (59 dB).
constexpr double kMaxPsnrDb = 100.0;

/// Structural similarity (Wang et al., TIP 2004), mean over the image; 1 = identical.
/// OpenCV's implementation: Gaussian window of 11x11, 1.5 px.
/// \throws UnavailableError without OpenCV's quality module
double ssim(const cv::Mat& image, const cv::Mat& truth);

/// Standard deviation of white noise [DN]: the median absolute response to the difference of two
/// Laplacians (Immerkaer, CVIU 1996: blind to planes and straight edges along the axes), scaled for
/// a Gaussian. The median instead of Immerkaer's mean keeps texture out as long as it covers less
/// than half of the image.
double noiseSigma(const cv::Mat& image);

/// Sharpness of an image, from gradients g = Sobel 3x3 / 8 [DN/px].
struct Sharpness {
  /// Tenengrad: mean of gx^2 + gy^2 [DN^2/px^2]. Grows with noise just as with sharper edges.
  double tenengrad = 0.0;
  /// Tenengrad less what white noise of noiseSigma() adds to it, 3/8 sigma^2 (each Sobel kernel
  /// over 8 has squared weights of 12/64); at least 0. Compares images of different noise.
  double tenengrad_above_noise = 0.0;
  double noise_sigma_dn = 0.0;  ///< noiseSigma()
};

/// Borders of one pixel do not count. \pre at least 3x3 px
Sharpness sharpness(const cv::Mat& image);

}  // namespace fast_edi
