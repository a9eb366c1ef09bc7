#include "replay/frame_replay.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "fast_edi/base/parameter_ranges.hpp"
#include "fast_edi/messages/image_pixels.hpp"
#include "fast_edi/messages/message_frame_sink.hpp"
#include "fast_edi/pipeline/deblurrer.hpp"
#include "node/comparison_view.hpp"

namespace fast_edi {
namespace {

/// For the ramps of the first events, and for learning what the frame before covers.
constexpr std::size_t kLeastFramesBefore = 1;

std::size_t framesThatWeigh(double temporal_weight) {
  constexpr double kHalfLevel = 0.5 / 255.0;
  if (temporal_weight <= 0.0) {
    return kLeastFramesBefore;
  }
  const double frames = std::ceil(std::log(kHalfLevel) / std::log(temporal_weight));
  return std::max(kLeastFramesBefore, static_cast<std::size_t>(frames));
}

/// The events panel of the `comparison` topic.
cv::Mat drawEvents(const ComparisonView& view, const ReplayedFrame& frame, std::int64_t offset_ns) {
  const ExposureInterval& exposure = frame.result.exposure;
  if (!frame.result.input.supported || exposure.length() == 0) {
    return {};
  }
  const sensor_msgs::ImagePtr drawn = view.draw(
      *frame.input, *frame.output, {exposure.start_ns + offset_ns, exposure.end_ns + offset_ns});
  const int width = static_cast<int>(frame.input->width);
  return colourPixels(*drawn).colRange(width, 2 * width).clone();
}

}  // namespace

std::size_t framesBefore(const DeblurParameters& parameters) {
  return framesThatWeigh(parameters.filter.enabled ? parameters.filter.temporal : 0.0);
}

std::size_t mostFramesBefore() {
  return framesThatWeigh(limits::kFilterTemporal.range.highest);
}

ReplayedFrame replayFrame(const FrameWindow& window, const LoadedParameters& parameters) {
  const DeblurParameters& deblur = parameters.deblur;
  const std::size_t frame = window.frame();
  const std::size_t first = frame - std::min(frame, framesBefore(deblur));
  const std::int64_t start_ns = window.recordTime(first) - window.margin();
  ReplayedFrame replayed;
  MessageFrameSink sink(parameters.ros.frame_id,
                        [&](const sensor_msgs::ImagePtr& image, const sensor_msgs::CameraInfoPtr&,
                            const OutputFrame& result) {
                          if (messageFrame(result.input).message == replayed.input) {
                            replayed.output = image;
                            replayed.result = result;
                          }
                        });
  Deblurrer deblurrer(deblur, sink);
  ComparisonView view;
  for (const ReplayItem& item : window.items()) {
    if (item.record_ns < start_ns || (item.frame && (item.index < first || item.index > frame))) {
      continue;
    }
    if (replayed.output) {
      break;
    }
    if (!item.frame) {
      const WireEvents events{item.events.data(), item.events.size() / kWireEventBytes};
      deblurrer.addEvents(events, item.size, item.sequence, item.record_ns);
      view.addEvents(events, item.size, deblur.event_mapping);
      continue;
    }
    if (item.index == frame) {
      replayed.input = item.frame;
    }
    deblurrer.addFrame(makeInputFrame(item.frame, readImage(*item.frame), item.record_ns),
                       item.record_ns);
    // As many as frames, so that each belongs to its own: 0 is none.
    deblurrer.addExposure(item.exposure_us, item.record_ns);
  }
  deblurrer.finish();
  if (replayed.output) {
    replayed.events = drawEvents(view, replayed, deblur.time_offset_ns + deblur.event_delay_ns);
  }
  return replayed;
}

}  // namespace fast_edi
