/// \file
/// The whole pipeline without ROS: events, frames and exposure messages go in as they arrive, one
/// image for each frame comes out. Live nodelet and `deblur_bag` both run this class.
///
///     events ------> EventStream -> PixelEventLists --+
///     frames ------> ExposureWindow (window known) ---+-> DoubleIntegral -> CameraResponse -> sink
///     exposures ---> ExposurePairing --^
///
/// When the sink wants a high-rate video, LatentVideo computes it behind each deblurred frame.
///
/// Frames wait in one queue and leave it in the order of their arrival. WindowPredictor predicts
/// the next window, so that DoubleIntegral accumulates its events as they arrive.
///
/// Clock. `now_ns` is the arrival time on a clock that never goes back: a steady clock live, the
/// bag's record time offline. It is used for the close timeout only and never compared with stamps.
///
/// Not thread safe: calls must not overlap. Never throws out of the add...() and advance() calls
/// except std::bad_alloc.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "fast_edi/base/deblur_counters.hpp"
#include "fast_edi/base/frame_sink.hpp"
#include "fast_edi/base/types.hpp"
#include "fast_edi/events/event_wire.hpp"
#include "fast_edi/parameters/parameters.hpp"

namespace fast_edi {

/// Current state, for diagnostics.
struct DeblurStatus {
  std::size_t buffered_events = 0;
  std::size_t buffer_bytes = 0;  ///< lists and per-pixel state
  std::size_t waiting_frames = 0;
  bool events_seen = false;
  bool exposure_known = false;
  SensorSize sensor_size;  ///< zero until the first event array or frame
  std::int64_t last_exposure_ns = 0;
  ContrastThresholds thresholds;    ///< in force: given or learned
  std::int64_t event_delay_ns = 0;  ///< in force: given or learned
  int learned_pairs = 0;            ///< of frames that these were learned from; 0: given
  /// At the last frame that was passed through for PassReason::kClocksDiffer; zero before.
  ClockPair differing_clocks;
};

class Deblurrer {
 public:
  /// \param sink must outlive this object
  /// \throws std::invalid_argument naming the parameter that is out of range
  Deblurrer(const DeblurParameters& parameters, FrameSink& sink);
  ~Deblurrer();
  Deblurrer(const Deblurrer&) = delete;
  Deblurrer& operator=(const Deblurrer&) = delete;

  /// One event array. \p size is the sensor size that the array states, \p sequence its header.seq
  /// (gaps are counted and mark events as missing; a value that does not increase is ignored).
  void addEvents(const WireEvents& events, SensorSize size, std::uint32_t sequence,
                 std::int64_t now_ns);
  /// The same for plain events: same images, same counters. Events whose time lies outside
  /// [0, 2^32 s) are dropped (events_glitched). Without sequence numbers, lost arrays are not
  /// noticed: report them with noteMissingArrays() or noteLostEvents().
  /// \param events \p count events in the order of time, origin top left; not used after the call
  /// \param size width and height of the sensor
  /// \param now_ns arrival time, see above
  void addEvents(const Event* events, std::size_t count, SensorSize size, std::int64_t now_ns);
  /// Events between the last array and the next were dropped before they got here, because too many
  /// were waiting: counted as arrived and overflowed, and missing in the frames they belong to.
  void noteLostEvents(std::size_t events);
  /// Arrays will be missing between the last one and the next: the caller does not receive any for
  /// now. The next array's sequence number tells how many. Until then, frames that would wait for
  /// events are passed through at once.
  void noteMissingArrays();
  void addFrame(InputFrame frame, std::int64_t now_ns);
  void addExposure(std::int32_t exposure_us, std::int64_t now_ns);
  /// Closes frames whose timeout has expired. Call it at least every few milliseconds.
  void advance(std::int64_t now_ns);
  /// Closes all waiting frames with the events received so far: the end of a bag.
  void finish();
  /// Discards events and waiting frames (which get no output: frames_abandoned), for a time in
  /// which nothing is received. The next events start a new stream.
  void pause();

  /// Changes parameters between two frames. Frames closed from now on, including those that wait,
  /// are those of a new object with the new parameters, bit for bit, as long as their events are
  /// still stored: events before the start of the last frame are not. Two things are kept
  /// (filter.temporal restarts):
  /// - What was learned from the recording, unless the thresholds, time offset, event delay,
  /// event_mapping,
  ///   weighting, response, the exposure intervals (stamp_reference, exposure_source,
  ///   exposure_time), filter.enabled or what to learn changes: then learning restarts from the
  ///   given values.
  /// - Output stamps keep increasing: a frame that another `reference` would place at or before the
  ///   last output is suppressed.
  /// Frames whose exposure message is awaited stop waiting when exposure_source changes.
  ///
  /// No event is lost, except that new limits (max_buffered_events, max_backward_jump,
  /// max_forward_jump) and another event_mapping empty the lists: frames that need events from
  /// before are passed through.
  /// \throws std::invalid_argument and keeps the old ones when one is out of range
  void setParameters(const DeblurParameters& parameters);
  const DeblurParameters& parameters() const;

  const DeblurCounters& counters() const;
  /// As in status(), without the cost of the rest.
  std::size_t bufferedEvents() const;
  DeblurStatus status() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fast_edi
