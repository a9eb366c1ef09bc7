/// \file
/// AprilTags (family 36h11) on the simulated plane.
#pragma once

#include <array>
#include <vector>

#include <opencv2/core.hpp>

#include "fast_edi/base/types.hpp"
#include "scenes/random.hpp"

namespace fast_edi {

/// A tag on the plane. Plane coordinates are in px of the nominal view, origin in its centre.
struct PlacedTag {
  int id = 0;
  cv::Point2d centre;
  double side_px = 0.0;    ///< side of the black square
  double angle_rad = 0.0;  ///< counter-clockwise from x to y

  /// Corners of the black square enlarged by \p factor.
  std::array<cv::Point2d, 4> corners(double factor = 1.0) const;
};

/// Sheet of paper around a tag, relative to the side of its black square of 8 cells: one cell of
/// white that belongs to the tag and half a cell of margin on each side.
constexpr double kTagPaperFactor = 11.0 / 8.0;

/// Tag \p id cell by cell, with its white border: CV_8UC1, 0 or 255.
/// \throws std::invalid_argument when the family has no such id
cv::Mat1b tagCells(int id);

/// Spreads \p count tags over the view, slightly turned and off the grid.
/// \throws std::invalid_argument when they do not fit side by side
std::vector<PlacedTag> placeTags(int count, double side_px, SensorSize view, RandomEngine& random);

/// Draws a tag with its sheet of paper.
/// \param canvas CV_32FC3, linear reflectance
/// \param scale canvas elements per plane px; the plane's origin is the canvas centre
void drawTag(const PlacedTag& tag, double scale, cv::Mat3f& canvas);

}  // namespace fast_edi
