/// \file
/// Pictures of AprilTags with known corners.
#pragma once

#include <array>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "fast_edi/tags/tag_detector.hpp"
#include "scenes/april_tags.hpp"

namespace fast_edi {
namespace test {

constexpr int kBlackCellsAcross = 8;  // the black square that corners refer to

/// A grey frame with a tag seen through a homography, blurred as by a lens.
/// \param corners of the black square by TagCorner [px], the centre of the top left pixel is (0, 0)
inline cv::Mat frameWithTag(int id, const std::array<cv::Point2d, 4>& corners,
                            cv::Size size = {346, 260}) {
  constexpr int kOversampling = 4;
  const cv::Mat1b cells = tagCells(id);
  cv::Mat big;
  constexpr int kCellTexels = 16;
  cv::resize(cells, big, {}, kCellTexels, kCellTexels, cv::INTER_NEAREST);
  // Texel edges in the coordinates of texel centres.
  const float low = kCellTexels - 0.5F;
  const float high = kCellTexels * (kBlackCellsAcross + 1) - 0.5F;
  const std::vector<cv::Point2f> from = {{low, high}, {high, high}, {high, low}, {low, low}};
  std::vector<cv::Point2f> to;
  for (const cv::Point2d& corner : corners) {
    to.emplace_back(static_cast<float>((corner.x + 0.5) * kOversampling - 0.5),
                    static_cast<float>((corner.y + 0.5) * kOversampling - 0.5));
  }
  cv::Mat fine(size * kOversampling, CV_8UC1, cv::Scalar(140));
  cv::warpPerspective(big, fine, cv::getPerspectiveTransform(from, to), fine.size(),
                      cv::INTER_LINEAR, cv::BORDER_TRANSPARENT);
  cv::Mat frame;
  cv::resize(fine, frame, size, 0, 0, cv::INTER_AREA);
  return frame;
}

/// Corners of an upright square.
inline std::array<cv::Point2d, 4> squareAt(cv::Point2d centre, double side) {
  const double half = 0.5 * side;
  return {centre + cv::Point2d(-half, half), centre + cv::Point2d(half, half),
          centre + cv::Point2d(half, -half), centre + cv::Point2d(-half, -half)};
}

}  // namespace test
}  // namespace fast_edi
