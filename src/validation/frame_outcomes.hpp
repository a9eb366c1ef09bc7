/// \file
/// What becomes of each frame of a recording: the pipeline itself, which renders no image.
#pragma once

#include <cstdint>
#include <string>

#include "fast_edi/base/frame_sink.hpp"
#include "fast_edi/pipeline/deblurrer.hpp"
#include "survey/frame_log.hpp"

namespace fast_edi {

/// Counts are those of deblur_bag over the same messages: the same class makes them. Only the delay
/// of the events is not learned (refine_delay), so that a frame whose exposure begins or ends
/// within that delay of a gap may be counted otherwise.
class FrameOutcomes : private FrameSink {
 public:
  /// \throws std::invalid_argument naming the parameter that is out of range
  explicit FrameOutcomes(const DeblurParameters& parameters);

  /// Messages in the order of their record times.
  void addEvents(const WireEvents& events, SensorSize size, std::uint32_t sequence,
                 std::int64_t record_ns);
  void addFrame(const FrameMessage& frame);
  void addExposure(std::int32_t exposure_us, std::int64_t record_ns);
  /// No message will come any more.
  void finish() { deblurrer_.finish(); }

  const DeblurCounters& counters() const { return deblurrer_.counters(); }
  /// One line for people, e.g. "9 deblurred, 1 passed through (1 exposure unknown)".
  std::string describe() const;

 private:
  MutableImageView begin(const InputFrame& input) override;
  void finish(const OutputFrame& output) override;
  std::int64_t advance(std::int64_t record_ns);

  Deblurrer deblurrer_;
  std::int64_t now_ns_ = INT64_MIN;
};

}  // namespace fast_edi
