/// \file
/// What the pipeline counts, and the reasons for which it passes frames through.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

namespace fast_edi {

/// Why a frame was passed through unchanged.
enum class PassReason {
  kPassthroughParameter,  ///< `passthrough` is set
  kUnsupportedEncoding,
  kSizeMismatch,     ///< frame and event array differ in size
  kExposureUnknown,  ///< neither topic nor parameter
  kNoEventStream,    ///< start-up: no event array was ever seen
  kEventsMissing,    ///< start-up, flush, overflow, a gap or the stream's end inside the exposure
  kClocksDiffer,     ///< events do come, all of them more than a second away from the exposure
  kTooManyWaiting,   ///< had to make room for a newer frame before its events came
};
constexpr std::size_t kPassReasonCount = 8;
/// A short phrase for people, e.g. "exposure unknown".
const char* toString(PassReason reason);

/// What the clocks of frames and events showed at one instant.
struct ClockPair {
  std::int64_t frame_ns = 0;   ///< stamp of a frame, shifted by time_offset
  std::int64_t events_ns = 0;  ///< newest event
};
/// For people, e.g. "the last such frame is stamped 20.000 s, the newest event 10.000 s".
std::string toString(const ClockPair& clocks);

/// Counts since construction. Everything that is dropped or refused is counted.
struct DeblurCounters {
  std::uint64_t events_in = 0;          ///< records that arrived
  std::uint64_t events_late = 0;        ///< older than the newest: dropped
  std::uint64_t events_outside = 0;     ///< not on the sensor: dropped
  std::uint64_t events_glitched = 0;    ///< unconfirmed time jump, or no stamp (isStamp()): dropped
  std::uint64_t events_refused = 0;     ///< in an array without a valid sensor size: dropped
  std::uint64_t events_overflowed = 0;  ///< max_buffered_events reached: oldest dropped
  std::uint64_t events_repeated = 0;    ///< in arrays that had come before: dropped
  std::uint64_t event_arrays = 0;
  std::uint64_t event_arrays_refused = 0;   ///< width or height not within 1..32767
  std::uint64_t event_arrays_repeated = 0;  ///< came before, within max_backward_jump
  std::uint64_t event_array_gaps = 0;       ///< holes in header.seq
  std::uint64_t event_arrays_missing = 0;   ///< numbers left out by those holes
  std::uint64_t event_restarts = 0;         ///< header.seq fell: the publisher was restarted
  std::uint64_t event_time_jumps = 0;
  std::uint64_t frame_time_jumps = 0;
  std::uint64_t size_changes = 0;  ///< sensor size of the event arrays changed
  std::uint64_t frames_in = 0;
  std::uint64_t frames_deblurred = 0;
  std::uint64_t frames_still = 0;      ///< of those: no event in the exposure
  std::uint64_t frames_timed_out = 0;  ///< closed by close_timeout with what had come
  std::array<std::uint64_t, kPassReasonCount> frames_passed{};
  std::uint64_t frames_suppressed = 0;  ///< output stamp not later than the last one: no output
  std::uint64_t frames_abandoned = 0;   ///< waited when listening ended: no output
  std::uint64_t calibration_fits = 0;   ///< pairs of frames that the calibration learned from
  std::uint64_t calibration_holes = 0;  ///< pairs without events between their exposures
  std::uint64_t calibration_contradictions = 0;  ///< pairs that do not change as their events say
  std::uint64_t latent_images = 0;               ///< of the high-rate video
  std::uint64_t exposures_in = 0;
  std::uint64_t exposures_refused = 0;  ///< <= 0 or > 1 s
  std::uint64_t exposures_surplus = 0;
  std::uint64_t exposures_missing = 0;
  std::uint64_t windows_predicted = 0;  ///< exposures that had been predicted
  std::uint64_t windows_not_predicted = 0;
  std::uint64_t pixels_out_of_range = 0;

  std::uint64_t framesPassed() const;
};

}  // namespace fast_edi
