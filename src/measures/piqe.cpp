#include "measures/piqe.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "measures/image_metrics.hpp"

namespace fast_edi {
namespace {

constexpr int kContrastWindowPx = 7;
constexpr double kWindowSigmaPx = 7.0 / 6.0;
constexpr double kActiveVariance = 0.1;
constexpr double kFlatDeviation = 0.1;
constexpr int kSegmentPx = 6;
constexpr double kNoiseFactor = 2.0;
constexpr double kPoolingConstant = 1.0;

double sampleDeviation(const cv::Mat1d& values) {
  const double mean = cv::mean(values)[0];
  double sum = 0.0;
  for (const double value : values) {
    sum += (value - mean) * (value - mean);
  }
  return std::sqrt(sum / static_cast<double>(values.total() - 1));
}

bool hasFlatSegment(const cv::Mat1d& edge) {
  const bool is_row = edge.rows == 1;
  for (int start = 0; start + kSegmentPx <= kPiqeBlockPx; ++start) {
    const cv::Mat1d segment = is_row ? edge.colRange(start, start + kSegmentPx)
                                     : edge.rowRange(start, start + kSegmentPx);
    if (sampleDeviation(segment) < kFlatDeviation) {
      return true;
    }
  }
  return false;
}

bool hasNoticeableDistortion(const cv::Mat1d& block) {
  const int last = kPiqeBlockPx - 1;
  return hasFlatSegment(block.row(0)) || hasFlatSegment(block.row(last)) ||
         hasFlatSegment(block.col(0)) || hasFlatSegment(block.col(last));
}

bool hasNoise(const cv::Mat1d& block, double deviation) {
  const int middle = kPiqeBlockPx / 2;
  const cv::Mat1d centre = block.colRange(middle - 1, middle + 1);
  // See step 3: the right column of the centre counts here, too, and its neighbour does not.
  cv::Mat1d surround;
  cv::hconcat(std::vector<cv::Mat>{block.colRange(0, middle - 1), block.col(middle),
                                   block.colRange(middle + 2, kPiqeBlockPx)},
              surround);
  const double surround_deviation = sampleDeviation(surround);
  const double ratio =
      surround_deviation > 0.0 ? sampleDeviation(centre) / surround_deviation : 0.0;
  const double beta = std::abs(deviation - ratio) / std::max(deviation, ratio);
  return deviation > kNoiseFactor * beta;
}

int paddingToBlocks(int length) {
  return (kPiqeBlockPx - length % kPiqeBlockPx) % kPiqeBlockPx;
}

}  // namespace

cv::Mat1d normalisedCoefficients(const cv::Mat& image) {
  cv::Mat1d values;
  image.convertTo(values, CV_64F);
  const auto local_mean = [](const cv::Mat1d& of) {
    cv::Mat1d mean;
    cv::GaussianBlur(of, mean, {kContrastWindowPx, kContrastWindowPx}, kWindowSigmaPx,
                     kWindowSigmaPx, cv::BORDER_REPLICATE);
    return mean;
  };
  const cv::Mat1d mean = local_mean(values);
  const cv::Mat1d variance = cv::abs(local_mean(values.mul(values)) - mean.mul(mean));
  cv::Mat1d deviation;
  cv::sqrt(variance, deviation);
  return (values - mean) / (deviation + 1.0);
}

PiqeBlock assessPiqeBlock(const cv::Mat1d& coefficients) {
  PiqeBlock block;
  const double deviation = sampleDeviation(coefficients);
  block.variance = deviation * deviation;
  block.active = block.variance > kActiveVariance;
  if (block.active) {
    block.noticeable = hasNoticeableDistortion(coefficients);
    block.noise = hasNoise(coefficients, deviation);
  }
  return block;
}

PiqeResult piqe(const cv::Mat& image) {
  requireMono8(image, "PIQE");
  cv::Mat padded;
  cv::copyMakeBorder(image, padded, 0, paddingToBlocks(image.rows), 0, paddingToBlocks(image.cols),
                     cv::BORDER_REFLECT);
  const cv::Mat1d coefficients = normalisedCoefficients(padded);

  PiqeResult result;
  double distortion = 0.0;
  for (int y = 0; y < coefficients.rows; y += kPiqeBlockPx) {
    for (int x = 0; x < coefficients.cols; x += kPiqeBlockPx) {
      const PiqeBlock block =
          assessPiqeBlock(coefficients(cv::Rect(x, y, kPiqeBlockPx, kPiqeBlockPx)));
      ++result.blocks;
      result.active_blocks += block.active ? 1 : 0;
      result.noticeable_blocks += block.noticeable ? 1 : 0;
      result.noise_blocks += block.noise ? 1 : 0;
      distortion += block.distortion();
    }
  }
  result.score =
      100.0 * (distortion + kPoolingConstant) / (result.active_blocks + kPoolingConstant);
  return result;
}

}  // namespace fast_edi
