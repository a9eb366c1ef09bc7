/// \file
/// SURF (Bay et al., CVIU 2008) by dlib, whose headers stay within surf.cpp.
#pragma once

#include <vector>

#include <opencv2/core.hpp>

#include "measures/feature_matches.hpp"

namespace fast_edi {

/// Where a descriptor is wanted.
struct SurfPlace {
  cv::Point2d centre;     ///< [px]
  double diameter = 0.0;  ///< side of the square that the descriptor covers [px]
};

/// Finds and describes SURF points of a CV_8UC1 image. \throws UnavailableError without dlib
ImageFeatures findSurf(const cv::Mat& image);
/// Describes given places; those whose square, turned any way, does not fit into the image are left
/// out. \throws UnavailableError without dlib
ImageFeatures describeSurf(const cv::Mat& image, const std::vector<SurfPlace>& places);

}  // namespace fast_edi
