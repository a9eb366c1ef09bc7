#include "validation/frame_outcomes.hpp"

#include <algorithm>
#include <cstddef>

#include "survey/finding.hpp"

namespace fast_edi {
namespace {

DeblurParameters withoutFilters(DeblurParameters parameters) {
  parameters.filter.enabled = false;
  parameters.latent = {};
  return parameters;
}

}  // namespace

FrameOutcomes::FrameOutcomes(const DeblurParameters& parameters)
    : deblurrer_(withoutFilters(parameters), *this) {}

/// As for a bag: a damaged record time does not turn the clock back.
std::int64_t FrameOutcomes::advance(std::int64_t record_ns) {
  now_ns_ = std::max(now_ns_, record_ns);
  deblurrer_.advance(now_ns_);
  return now_ns_;
}

void FrameOutcomes::addEvents(const WireEvents& events, SensorSize size, std::uint32_t sequence,
                              std::int64_t record_ns) {
  deblurrer_.addEvents(events, size, sequence, advance(record_ns));
}

void FrameOutcomes::addFrame(const FrameMessage& frame) {
  InputFrame input;
  input.stamp_ns = frame.stamp_ns;
  input.image.size = frame.size;  // no pixels: nothing is rendered
  input.supported = frame.fault.empty();
  deblurrer_.addFrame(std::move(input), advance(frame.record_ns));
}

void FrameOutcomes::addExposure(std::int32_t exposure_us, std::int64_t record_ns) {
  deblurrer_.addExposure(exposure_us, advance(record_ns));
}

MutableImageView FrameOutcomes::begin(const InputFrame&) {
  return {};
}

void FrameOutcomes::finish(const OutputFrame&) {}

std::string FrameOutcomes::describe() const {
  const DeblurCounters& counters = deblurrer_.counters();
  std::string text = textOf("%llu deblurred", count(counters.frames_deblurred));
  if (counters.frames_still > 0) {
    text +=
        textOf(" (%llu of them without any event: a still scene)", count(counters.frames_still));
  }
  text += textOf(", %llu passed through unchanged", count(counters.framesPassed()));
  std::string reasons;
  for (std::size_t i = 0; i < kPassReasonCount; ++i) {
    if (counters.frames_passed[i] > 0) {
      reasons += textOf("%s%llu %s", reasons.empty() ? "" : ", ", count(counters.frames_passed[i]),
                        toString(static_cast<PassReason>(i)));
    }
  }
  text += reasons.empty() ? "" : " (" + reasons + ")";
  if (counters.frames_suppressed > 0) {
    text += textOf(", %llu without output: stamp not later than the one before",
                   count(counters.frames_suppressed));
  }
  return text;
}

}  // namespace fast_edi
