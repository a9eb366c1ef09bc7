/// \file
/// What a tuning shows: the frame, its events and the deblurred frame, and below them the sliders
/// with their values.
#pragma once

#include <string>

#include <opencv2/core.hpp>

#include "tuning/tuning_session.hpp"

namespace fast_edi {

/// A frame as it is shown.
struct TunedFrame {
  cv::Mat blurry;           ///< CV_8UC1 or CV_8UC3
  cv::Mat events;           ///< of the exposure, CV_8UC3; may be empty
  cv::Mat deblurred;        ///< as the blurry one; empty where there is none
  std::string description;  ///< exposure, events, why it was not deblurred
};

/// CV_8UC3 (BGR). Dim frames are shown brighter, which the picture says. The size depends on that
/// of the frame, the number of sliders and the help. \pre frame.blurry is not empty
cv::Mat drawTuning(const TuningSession& session, const TunedFrame& frame);

/// In short: the frame, the chosen slider and its value, the message.
std::string tuningTitle(const TuningSession& session);

}  // namespace fast_edi
