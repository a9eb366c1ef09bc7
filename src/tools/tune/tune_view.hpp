/// \file
/// The frame of a tuning session, deblurred, and the picture of it.
#pragma once

#include <opencv2/core.hpp>

#include "replay/frame_window.hpp"
#include "tools/tune/tune_arguments.hpp"
#include "tools/tune/tune_start.hpp"
#include "tuning/tuning_picture.hpp"
#include "tuning/tuning_session.hpp"

namespace fast_edi::tune {

class View {
 public:
  /// \param arguments must outlive this object
  View(const Arguments& arguments, const Start& start);

  /// Deblurs the session's frame.
  /// \throws std::runtime_error when the recording does not have it any more
  void update(const TuningSession& session);
  cv::Mat draw(const TuningSession& session) const { return drawTuning(session, frame_); }

 private:
  FrameWindow window_;
  TunedFrame frame_;
};

}  // namespace fast_edi::tune
