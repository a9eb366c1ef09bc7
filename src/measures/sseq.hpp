/// \file
/// SSEQ, a no-reference quality score (Liu et al., "No-reference image quality assessment based on
/// spatial and spectral entropies", Signal Processing: Image Communication 29, 2014). 0 = best,
/// 100 = worst.
///
/// Features, for scales 1, 1/2 and 1/4 of the image, in blocks of 8x8 (the last row and column of
/// blocks filled up with zeros): the block's spatial entropy -sum p log2 p over its grey levels,
/// and its spectral entropy, the same with p = squared DCT coefficients without the constant one,
/// normalised. Of each, the mean of the values between the 20th and the 80th percentile, and the
/// skewness of all: 12 features.
///
/// Score = 50 + 50 sum_k P(k) r_k: P by a classifier of five distortions, r_k by one regression for
/// each, features scaled to [-1, 1].
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

namespace fast_edi {

constexpr int kSseqFeatures = 12;

/// -sum p log2 p of an 8-bit block's grey levels [bit].
double spatialEntropy(const cv::Mat1b& block);
/// Entropy of the normalised DCT power without its constant term [bit]; 0 for a constant block.
/// \pre even numbers of rows and columns
double spectralEntropy(const cv::Mat1b& block);
/// Third standardised moment (population); 0 when all values are equal.
double skewness(const std::vector<double>& values);
/// Half the size, cubic interpolation over 8 pixels (anti-aliased), borders mirrored.
cv::Mat1b halved(const cv::Mat1b& image);

/// Features in the order of the model: for each scale spatial mean, spatial skewness, spectral
/// mean, spectral skewness. \throws std::invalid_argument unless \p image is CV_8UC1 and at least
/// 8x8
std::array<double, kSseqFeatures> sseqFeatures(const cv::Mat& image);

/// The trained model. Reads from a folder: class.libsvm (a 5-class SVC with probabilities),
/// regression_1.libsvm ... regression_5.libsvm, feature_range.txt (minimum and maximum of each
/// feature, '#' comments).
class Sseq {
 public:
  /// \throws UnavailableError without libsvm
  /// \throws std::runtime_error naming the file that is missing or not what it should be
  explicit Sseq(const std::string& model_folder);
  ~Sseq();
  Sseq(Sseq&&) noexcept;
  Sseq& operator=(Sseq&&) noexcept;

  /// \throws std::invalid_argument as sseqFeatures()
  double score(const cv::Mat& image) const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fast_edi
