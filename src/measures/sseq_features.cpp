#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include <opencv2/imgproc.hpp>

#include "measures/image_metrics.hpp"
#include "measures/sseq.hpp"

namespace fast_edi {
namespace {

constexpr int kBlockPx = 8;
constexpr int kScales = 3;
constexpr double kLowPercentile = 0.2;
constexpr double kHighPercentile = 0.8;

double entropyTerm(double p) {
  return p > 0.0 ? -p * std::log2(p) : 0.0;
}

/// Mean between the percentiles, ends included, counted from 1 and rounded up as the authors do.
double middleMean(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const double count = static_cast<double>(values.size());
  const auto first = std::max(1L, std::lround(std::ceil(count * kLowPercentile)));
  const auto last = std::max(first, std::lround(std::ceil(count * kHighPercentile)));
  return std::accumulate(values.begin() + (first - 1), values.begin() + last, 0.0) /
         static_cast<double>(last - first + 1);
}

int wholeBlocks(int length) {
  return (length + kBlockPx - 1) / kBlockPx * kBlockPx;
}

}  // namespace

double spatialEntropy(const cv::Mat1b& block) {
  std::array<int, 256> histogram{};
  for (const std::uint8_t value : block) {
    ++histogram[value];
  }
  const double total = static_cast<double>(block.total());
  double entropy = 0.0;
  for (const int count : histogram) {
    entropy += entropyTerm(count / total);
  }
  return entropy;
}

double spectralEntropy(const cv::Mat1b& block) {
  // In double, a constant block leaves rounding noise of this order relative to its constant term.
  constexpr double kRounding = 1e-20;
  cv::Mat1d values;
  block.convertTo(values, CV_64F);
  cv::Mat1d coefficients;
  cv::dct(values, coefficients);
  const double constant = coefficients(0, 0);
  coefficients(0, 0) = 0.0;
  const cv::Mat1d power = coefficients.mul(coefficients);
  const double total = cv::sum(power)[0];
  if (total <= kRounding * constant * constant) {
    return 0.0;
  }
  double entropy = 0.0;
  for (const double value : power) {
    entropy += entropyTerm(value / total);
  }
  return entropy;
}

double skewness(const std::vector<double>& values) {
  const double count = static_cast<double>(values.size());
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / count;
  double second = 0.0;
  double third = 0.0;
  for (const double value : values) {
    const double deviation = value - mean;
    second += deviation * deviation;
    third += deviation * deviation * deviation;
  }
  second /= count;
  third /= count;
  return second > 0.0 ? third / std::pow(second, 1.5) : 0.0;
}

cv::Mat1b halved(const cv::Mat1b& image) {
  // Keys' cubic kernel (a = -1/2), stretched by two for half the sampling rate, at the distances
  // 3.5, 2.5, 1.5, 0.5, ... px of the eight neighbours.
  const cv::Mat1d kernel =
      (cv::Mat1d(8, 1) << -3.0, -9.0, 29.0, 111.0, 111.0, 29.0, -9.0, -3.0) / 256.0;
  // Output pixel i lies between input pixels 2 i and 2 i + 1, which are the kernel's middle two.
  const cv::Point anchor(3, 3);
  cv::Mat1d filtered;
  cv::sepFilter2D(image, filtered, CV_64F, kernel, kernel, anchor, 0.0, cv::BORDER_REFLECT);
  cv::Mat1b result((image.rows + 1) / 2, (image.cols + 1) / 2);
  for (int y = 0; y < result.rows; ++y) {
    for (int x = 0; x < result.cols; ++x) {
      result(y, x) = cv::saturate_cast<std::uint8_t>(filtered(2 * y, 2 * x));
    }
  }
  return result;
}

std::array<double, kSseqFeatures> sseqFeatures(const cv::Mat& image) {
  requireMono8(image, "SSEQ");
  if (image.rows < kBlockPx || image.cols < kBlockPx) {
    throw std::invalid_argument("SSEQ: expected at least 8x8 pixels");
  }
  std::array<double, kSseqFeatures> features{};
  std::size_t next = 0;
  cv::Mat1b scaled = image;
  for (int scale = 0; scale < kScales; ++scale) {
    cv::Mat1b padded;
    cv::copyMakeBorder(scaled, padded, 0, wholeBlocks(scaled.rows) - scaled.rows, 0,
                       wholeBlocks(scaled.cols) - scaled.cols, cv::BORDER_CONSTANT, cv::Scalar(0));
    std::vector<double> spatial;
    std::vector<double> spectral;
    for (int y = 0; y < padded.rows; y += kBlockPx) {
      for (int x = 0; x < padded.cols; x += kBlockPx) {
        const cv::Mat1b block = padded(cv::Rect(x, y, kBlockPx, kBlockPx));
        spatial.push_back(spatialEntropy(block));
        spectral.push_back(spectralEntropy(block));
      }
    }
    for (const std::vector<double>& entropies : {spatial, spectral}) {
      features[next++] = middleMean(entropies);
      features[next++] = skewness(entropies);
    }
    scaled = halved(scaled);
  }
  return features;
}

}  // namespace fast_edi
