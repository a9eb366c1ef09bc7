/// \file
/// Trajectories from above, drawn with OpenCV, which is there anyway: no other tool is needed.
#pragma once

#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "trajectory/trajectory_error.hpp"

namespace fast_edi {

/// A trajectory from above: truth and aligned estimate, in metres, with the ends marked.
/// \return CV_8UC3
cv::Mat topViewPlot(const std::string& title, const TrajectoryError& error);

}  // namespace fast_edi
