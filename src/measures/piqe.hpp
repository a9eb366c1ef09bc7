/// \file
/// PIQE, a no-reference quality score (Venkatanath et al., "Blind image quality evaluation using
/// perception based features", NCC 2015). 0 = best, 100 = worst; needs no trained model.
///
/// 1. Divisive normalisation of the image I by Gaussian-weighted local mean and deviation
///    (7x7, 7/6 px, borders replicated):  (I - mu) / (sigma + 1)
/// 2. Blocks of 16x16 (the image is mirrored at its right and lower border to a whole number of
///    blocks). A block is active when the variance v of its coefficients exceeds 0.1; only active
///    blocks count.
/// 3. An active block has a *noticeable distortion* (blocking, blur) when one of the segments of 6
///    pixels along its four edges has a standard deviation below 0.1, and *noise* when
///    sigma > 2 beta, beta = |sigma - r| / max(sigma, r), sigma^2 = v, r = deviation of the two
///    central columns (8 and 9 of 16) over that of the columns around them. These are all but 8 and
///    10: the program that is in use (MATLAB's `piqe`) takes column 8 out, and then the ninth of
///    those that remain. Scores are comparable only if that is kept.
/// 4. A block's distortion is D = (1 - v) [noticeable] + v [noise];
///    score = 100 (sum D + 1) / (active blocks + 1).
///
/// Standard deviations are those of a sample (n - 1), as in the authors' published code.
#pragma once

#include <opencv2/core.hpp>

namespace fast_edi {

constexpr int kPiqeBlockPx = 16;

/// What step 2 and 3 say of one block.
struct PiqeBlock {
  double variance = 0.0;
  bool active = false;
  bool noticeable = false;  ///< only looked at in active blocks
  bool noise = false;       ///< only looked at in active blocks

  double distortion() const {
    return (noticeable ? 1.0 - variance : 0.0) + (noise ? variance : 0.0);
  }
};

struct PiqeResult {
  double score = 0.0;  ///< 0..100 for images of usual contrast
  int blocks = 0;
  int active_blocks = 0;
  int noticeable_blocks = 0;
  int noise_blocks = 0;
};

/// Step 1, CV_64FC1 of the same size. \param image CV_8UC1, CV_32FC1 or CV_64FC1 [DN of 8 bits]
cv::Mat1d normalisedCoefficients(const cv::Mat& image);

/// Steps 2 and 3 for one block. \pre coefficients is kPiqeBlockPx x kPiqeBlockPx
PiqeBlock assessPiqeBlock(const cv::Mat1d& coefficients);

/// \param image CV_8UC1. An image without active blocks scores 100.
/// \throws std::invalid_argument for another type or an empty image
PiqeResult piqe(const cv::Mat& image);

}  // namespace fast_edi
