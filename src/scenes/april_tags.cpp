#include "scenes/april_tags.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>

#include <boost/random/uniform_real_distribution.hpp>
#include <opencv2/imgproc.hpp>

extern "C" {
#include <apriltag/apriltag.h>
#include <apriltag/tag36h11.h>
}

namespace fast_edi {
namespace {

/// Cells across a tag with its white border, and across its black square.
constexpr int kCells = 10;
constexpr int kBlackCells = 8;
/// Matte print under room light, veiling glare of the lens included.
constexpr float kPaperReflectance = 0.80F;
constexpr float kInkReflectance = 0.13F;
constexpr double kMaxTurnRad = 0.2;
constexpr int kSubpixelBits = 8;

cv::Point toFixed(const cv::Point2d& plane, double scale, const cv::Mat& canvas) {
  const double unit = 1 << kSubpixelBits;
  return {static_cast<int>(std::lround((plane.x * scale + 0.5 * canvas.cols - 0.5) * unit)),
          static_cast<int>(std::lround((plane.y * scale + 0.5 * canvas.rows - 0.5) * unit))};
}

}  // namespace

std::array<cv::Point2d, 4> PlacedTag::corners(double factor) const {
  const double half = 0.5 * side_px * factor;
  const double c = std::cos(angle_rad);
  const double s = std::sin(angle_rad);
  std::array<cv::Point2d, 4> points{cv::Point2d{-half, -half}, cv::Point2d{half, -half},
                                    cv::Point2d{half, half}, cv::Point2d{-half, half}};
  for (cv::Point2d& point : points) {
    point = centre + cv::Point2d(c * point.x - s * point.y, s * point.x + c * point.y);
  }
  return points;
}

cv::Mat1b tagCells(int id) {
  const std::unique_ptr<apriltag_family_t, decltype(&tag36h11_destroy)> family(tag36h11_create(),
                                                                               &tag36h11_destroy);
  if (id < 0 || id >= static_cast<int>(family->ncodes)) {
    throw std::invalid_argument("AprilTag 36h11: expected an id of 0 to " +
                                std::to_string(family->ncodes - 1) + ", got " + std::to_string(id));
  }
  // Not by apriltag_to_image(): that of libapriltag before 3.1.5 draws the white border where the
  // black one belongs.
  cv::Mat1b cells(kCells, kCells, std::uint8_t{255});
  constexpr int kBorder = (kCells - kBlackCells) / 2;
  cells(cv::Rect(kBorder, kBorder, kBlackCells, kBlackCells)).setTo(0);
  const std::uint64_t code = family->codes[id];
  for (std::uint32_t bit = 0; bit < family->nbits; ++bit) {
    // The most significant bit comes first, and places count from the black border's outside.
    if (((code >> (family->nbits - 1 - bit)) & 1U) != 0) {
      cells(kBorder + static_cast<int>(family->bit_y[bit]),
            kBorder + static_cast<int>(family->bit_x[bit])) = 255;
    }
  }
  return cells;
}

std::vector<PlacedTag> placeTags(int count, double side_px, SensorSize view, RandomEngine& random) {
  std::vector<PlacedTag> tags;
  if (count <= 0) return tags;
  const auto rows_for = [count](int columns) { return (count + columns - 1) / columns; };
  // As many columns as leave every tag the most room.
  int columns = 1;
  double room = 0.0;
  for (int candidate = 1; candidate <= count; ++candidate) {
    const double candidate_room = std::min(static_cast<double>(view.width) / candidate,
                                           static_cast<double>(view.height) / rows_for(candidate));
    if (candidate_room > room) {
      room = candidate_room;
      columns = candidate;
    }
  }
  const int rows = rows_for(columns);
  // A turned sheet of paper needs more room than a straight one.
  const double sheet = side_px * kTagPaperFactor * (std::cos(kMaxTurnRad) + std::sin(kMaxTurnRad));
  const double cell_height = static_cast<double>(view.height) / rows;
  if (sheet > static_cast<double>(view.width) / columns || sheet > cell_height) {
    throw std::invalid_argument("tags: " + std::to_string(count) + " tags with a side of " +
                                std::to_string(side_px) + " px do not fit into " +
                                std::to_string(view.width) + " x " + std::to_string(view.height) +
                                " px side by side; expected fewer or smaller ones");
  }
  boost::random::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (int id = 0; id < count; ++id) {
    const int row = id / columns;
    const int in_row = row + 1 < rows ? columns : count - columns * (rows - 1);
    const double cell_width = static_cast<double>(view.width) / in_row;
    PlacedTag tag;
    tag.id = id;
    tag.side_px = side_px;
    tag.centre.x = (id - row * columns + 0.5) * cell_width - 0.5 * view.width +
                   0.4 * (cell_width - sheet) * unit(random);
    tag.centre.y =
        (row + 0.5) * cell_height - 0.5 * view.height + 0.4 * (cell_height - sheet) * unit(random);
    tag.angle_rad = kMaxTurnRad * unit(random);
    tags.push_back(tag);
  }
  return tags;
}

void drawTag(const PlacedTag& tag, double scale, cv::Mat3f& canvas) {
  const auto fill = [&](const std::array<cv::Point2d, 4>& corners, float reflectance) {
    std::array<cv::Point, 4> fixed;
    for (std::size_t i = 0; i < corners.size(); ++i) fixed[i] = toFixed(corners[i], scale, canvas);
    cv::fillConvexPoly(canvas, fixed.data(), static_cast<int>(fixed.size()),
                       cv::Scalar::all(reflectance), cv::LINE_8, kSubpixelBits);
  };
  fill(tag.corners(kTagPaperFactor), kPaperReflectance);
  const cv::Mat1b cells = tagCells(tag.id);
  const std::array<cv::Point2d, 4> outer =
      tag.corners(static_cast<double>(kCells) / static_cast<double>(kBlackCells));
  const cv::Point2d along = (outer[1] - outer[0]) / kCells;
  const cv::Point2d down = (outer[3] - outer[0]) / kCells;
  for (int y = 0; y < cells.rows; ++y) {
    for (int x = 0; x < cells.cols; ++x) {
      if (cells(y, x) != 0) continue;
      const cv::Point2d corner = outer[0] + along * x + down * y;
      fill({corner, corner + along, corner + along + down, corner + down}, kInkReflectance);
    }
  }
}

}  // namespace fast_edi
