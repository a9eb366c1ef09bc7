/// \file
/// Tags drawn into a frame, for people.
#pragma once

#include <vector>

#include <opencv2/core.hpp>

#include "fast_edi/tags/tag_detector.hpp"

namespace fast_edi {

/// Outlines, each with its lower edge in another colour, and ids.
/// \param picture CV_8UC3, blue first
void drawTags(const std::vector<TagDetection>& tags, cv::Mat& picture);

}  // namespace fast_edi
