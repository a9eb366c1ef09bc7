#include "tools/tune/tune_view.hpp"

#include <cstdint>
#include <stdexcept>
#include <string>

#include "fast_edi/bags/open_messages.hpp"
#include "fast_edi/base/number_text.hpp"
#include "fast_edi/messages/image_pixels.hpp"
#include "fast_edi/messages/message_conversion.hpp"
#include "replay/frame_replay.hpp"
#include "survey/recording_survey.hpp"

namespace fast_edi::tune {
namespace {

/// Messages are recorded this long after their stamps at most.
constexpr std::int64_t kRecordDelay_ns = RecordingSurvey::kLargestDelay_ns;

/// Grey for an encoding that is not known.
cv::Mat pictureOf(const sensor_msgs::Image& image) {
  constexpr double kGrey = 128.0;
  return readImage(image).verdict == ImageVerdict::kSupported
             ? colourPixels(image)
             : cv::Mat(static_cast<int>(image.height), static_cast<int>(image.width), CV_8UC3,
                       cv::Scalar::all(kGrey));
}

std::string describe(const ReplayedFrame& frame) {
  constexpr int kDecimals = 2;
  if (!frame.output) {
    return "no output: its stamp is not later than that of the frame before";
  }
  const OutputFrame& result = frame.result;
  if (!result.deblurred) {
    return std::string("passed through: ") + toString(result.pass_reason);
  }
  const double length_ms = static_cast<double>(result.exposure.length()) /
                           static_cast<double>(kNanosecondsPerMillisecond);
  return "exposure " + fixedText(length_ms, kDecimals) + " ms, " + std::to_string(result.events) +
         " events";
}

}  // namespace

View::View(const Arguments& arguments, const Start& start)
    : window_([&arguments] { return openMessages(arguments.recordings); }, start.topics,
              start.exposures_us,
              {mostFramesBefore(), start.longest_exposure_ns + kRecordDelay_ns +
                                       kOffsetRange_us * kNanosecondsPerMicrosecond}) {}

void View::update(const TuningSession& session) {
  if (!window_.moveTo(session.frame())) {
    throw std::runtime_error("frame " + std::to_string(session.frame()) +
                             " is not there any more: was the recording changed?");
  }
  const ReplayedFrame replayed = replayFrame(window_, session.parameters().loaded());
  frame_.blurry = pictureOf(*replayed.input);
  frame_.deblurred = replayed.output ? pictureOf(*replayed.output) : cv::Mat();
  frame_.events = replayed.events;
  frame_.description = describe(replayed);
}

}  // namespace fast_edi::tune
