/// \file
/// A frame of a FrameWindow deblurred once more, with other parameters.
#pragma once

#include <cstddef>

#include <sensor_msgs/Image.h>
#include <opencv2/core.hpp>

#include "fast_edi/base/frame_sink.hpp"
#include "fast_edi/config/parameters_from_yaml.hpp"
#include "replay/frame_window.hpp"

namespace fast_edi {

/// How many frames before one have to be deblurred, too: filter_temporal blends an image with all
/// before it. Those that weigh less than half a grey level are left out.
std::size_t framesBefore(const DeblurParameters& parameters);
/// The largest number of these.
std::size_t mostFramesBefore();

struct ReplayedFrame {
  sensor_msgs::ImageConstPtr input;
  /// Deblurred, or passed through; null for a frame that gets no output, because its stamp is not
  /// later than that of the frame before.
  sensor_msgs::ImageConstPtr output;
  OutputFrame result;  ///< what became of it, if there is an output
  cv::Mat events;      ///< of its exposure, CV_8UC3; empty without a known exposure
};

/// The same bits as from deblur_bag with these parameters, as long as nothing is learned
/// (refine_contrast, refine_delay), and as the window reaches back far enough. With
/// filter_temporal, they are the same to a grey level, but for less than one pixel in a thousand.
/// \param window moved to the frame
/// \throws std::invalid_argument for parameters out of range
ReplayedFrame replayFrame(const FrameWindow& window, const LoadedParameters& parameters);

}  // namespace fast_edi
