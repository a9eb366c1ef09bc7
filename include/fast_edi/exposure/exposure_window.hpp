/// \file
/// The exposure of a waiting frame: what is known of it, and whether the frame can be closed.
#pragma once

#include <cstdint>
#include <optional>

#include "fast_edi/base/deblur_counters.hpp"
#include "fast_edi/base/types.hpp"
#include "fast_edi/events/event_stream.hpp"
#include "fast_edi/parameters/parameters.hpp"

namespace fast_edi {

/// [start, end) from an image stamp and what that stamp means. For kMid the driver's rule holds:
/// start = stamp - floor(L / 2) us, so that result.at(stamp_reference) == stamp_ns.
ExposureInterval exposureInterval(std::int64_t stamp_ns, std::int64_t length_ns,
                                  ExposureInstant stamp_reference);

/// What is to be done with a waiting frame.
enum class FrameState {
  kReady,                ///< can be deblurred
  kPassThrough,          ///< cannot be deblurred, see reason
  kWaitingForExposure,   ///< its exposure message may still come
  kWaitingForEvents,     ///< events of its exposure may still come
  kWaitingForEventJump,  ///< its clock jumped back, that of the events has not yet followed
};

struct FrameVerdict {
  FrameState state = FrameState::kWaitingForExposure;
  PassReason reason = PassReason::kPassthroughParameter;  ///< when state is kPassThrough

  bool isFinal() const { return state == FrameState::kReady || state == FrameState::kPassThrough; }
};

/// What a verdict depends on besides the exposure.
struct FrameTraits {
  bool supported = true;  ///< its encoding is
  SensorSize size;
  bool after_time_jump = false;  ///< the frames' clock jumped back to this frame's epoch
  /// No events came for as long as a frame waits: the scene may be still.
  bool stream_silent = true;
  /// The frame before was passed through because clocks differ.
  bool clocks_differed = false;
};

/// Events that all lie further from an exposure than this are stamped by another clock.
constexpr std::int64_t kClocksDiffer_ns = kNanosecondsPerSecond;

class ExposureWindow {
 public:
  /// \param awaits_message whether the frame's own exposure message may come; else the length is
  ///        the parameter's
  ExposureWindow(std::int64_t stamp_ns, bool awaits_message)
      : stamp_ns_(stamp_ns), source_(awaits_message ? Source::kAwaited : Source::kParameter) {}

  /// Ends the wait for the frame's message.
  /// \param length_ns by a message; nullopt: use the parameter
  void settle(std::optional<std::int64_t> length_ns);
  bool awaitsMessage() const { return source_ == Source::kAwaited; }

  std::int64_t stamp() const { return stamp_ns_; }
  /// Length of the exposure [ns], 0 while it is not known.
  std::int64_t length(const DeblurParameters& parameters) const;
  /// In frame time; zero length at the stamp while it is not known.
  ExposureInterval inFrameTime(const DeblurParameters& parameters) const;
  /// In event time: shifted by the time offset.
  ExposureInterval inEventTime(const DeblurParameters& parameters) const;

  /// \param out_of_time the frame's timeout is over, or for another reason nothing more is awaited:
  ///        the verdict is final unless the exposure message is still awaited
  ///        Then the scene is taken for still, with no event in the exposure, only where the stream
  ///        is silent: events that come but do not reach the exposure say nothing about it.
  FrameVerdict judge(const FrameTraits& frame, const EventStream& events,
                     const DeblurParameters& parameters, bool out_of_time) const;

 private:
  std::optional<PassReason> whyNotCovered(const FrameTraits& frame, const EventStream& events,
                                          const ExposureInterval& window) const;

  enum class Source { kAwaited, kMessage, kParameter };

  std::int64_t stamp_ns_;
  Source source_;
  std::int64_t message_length_ns_ = 0;
};

}  // namespace fast_edi
