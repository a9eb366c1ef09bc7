/// \file
/// The frames that wait for their exposure message and their events. They leave in the order of
/// their arrival: as soon as a verdict is final, or after the close timeout with the events
/// received so far.
///
/// Frames whose output stamp would not be later than the last one of their epoch are counted
/// (frames_suppressed) and left out.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "fast_edi/base/deblur_counters.hpp"
#include "fast_edi/base/frame_sink.hpp"
#include "fast_edi/events/event_stream.hpp"
#include "fast_edi/exposure/exposure_pairing.hpp"
#include "fast_edi/exposure/exposure_window.hpp"
#include "fast_edi/exposure/window_predictor.hpp"
#include "fast_edi/parameters/parameters.hpp"
#include "pipeline/frame_epoch.hpp"

namespace fast_edi {

/// A frame that has left the queue.
struct ClosedFrame {
  OutputFrame output;       ///< with input, output stamp and exposure
  ExposureInterval window;  ///< the exposure in event time
  std::uint64_t epoch = 0;  ///< of the frames' clock
  FrameVerdict verdict;     ///< final
};

class FrameQueue {
 public:
  /// As many as the image queue of the nodelet holds. More can only wait when something is wrong,
  /// and memory must not grow with it.
  static constexpr std::size_t kMaxFrames = 100;

  /// \param parameters in force, \param events to judge frames by, \param counters of frames and
  ///        exposures: all three must outlive this object
  FrameQueue(const DeblurParameters& parameters, const EventStream& events,
             DeblurCounters& counters);

  /// Time passes; see Deblurrer for the clock.
  void advance(std::int64_t now_ns);
  /// Events arrive at the time of the last advance().
  void noteEvents() { last_events_ns_ = now_ns_; }
  void addFrame(InputFrame frame);
  void addExposure(std::int32_t exposure_us);

  // Each returns nothing when no such frame is left; call it until then.

  /// The next frame that need not wait any longer.
  std::optional<ClosedFrame> takeReady();
  /// The next frame of more than kMaxFrames.
  std::optional<ClosedFrame> takeSurplus();
  /// The next frame, with the events received so far.
  std::optional<ClosedFrame> takeNext();
  /// The next frame, with the events received so far, if its exposure ends nearer to \p
  /// newest_event_ns, the last of an epoch of events, than to \p next_event_ns, the first of the
  /// next epoch.
  std::optional<ClosedFrame> takeBefore(std::int64_t newest_event_ns, std::int64_t next_event_ns);

  /// No exposure message will come any more.
  void endExposures();
  /// The event clock jumped: whether it differs from that of the frames is not known any more.
  void resetClocks() { clocks_differ_ = false; }
  /// Drops all frames (frames_abandoned) and begins a new epoch.
  void restart();
  /// To be called when the parameters in force were changed by the user.
  void parametersChanged(bool exposure_source_changed);

  /// The exposure that will be integrated next, in frame time: that of the first frame as far as it
  /// is known, else the predicted one. Nothing, or of length zero, when unknown.
  std::optional<ExposureInterval> nextExposure() const;

  std::size_t size() const { return waiting_.size(); }
  /// Of the last frame with a supported encoding.
  SensorSize frameSize() const { return frame_size_; }
  /// Length of the last exposure by the source in force, 0 when unknown.
  std::int64_t lastExposure() const;
  /// See DeblurStatus::differing_clocks.
  const ClockPair& differingClocks() const { return differing_clocks_; }

 private:
  struct WaitingFrame {
    InputFrame input;
    std::uint64_t number = 0;  ///< in order of arrival
    std::uint64_t epoch = 0;
    bool after_time_jump = false;  ///< its epoch began with a jump back
    std::int64_t arrival_ns = 0;
    ExposureWindow window;
  };

  bool exposuresByTopic() const { return parameters_.exposure_source == ExposureSource::kTopic; }
  void beginEpoch(bool after_time_jump);
  void assignExposures();
  void settle(WaitingFrame& frame);
  FrameVerdict judge(const WaitingFrame& frame, bool out_of_time) const;
  FrameVerdict judgeWithWhatHasCome(WaitingFrame& frame);
  std::optional<ClosedFrame> close(const FrameVerdict& verdict);
  void compareClocks(const FrameVerdict& verdict, const ExposureInterval& window);

  const DeblurParameters& parameters_;
  const EventStream& events_;
  DeblurCounters& counters_;
  ExposurePairing pairing_;
  std::vector<ExposureMatch> matches_;  ///< empty between calls; keeps its memory
  std::deque<WaitingFrame> waiting_;
  std::uint64_t next_number_ = 0;
  FrameEpoch epoch_;
  OutputOrder output_order_;
  WindowPredictor predictor_;
  SensorSize frame_size_;
  std::int64_t now_ns_ = INT64_MIN;
  std::optional<std::int64_t> last_events_ns_;  ///< arrival of the last array that holds any
  bool clocks_differ_ = false;                  ///< as the last frame showed
  ClockPair differing_clocks_;
};

}  // namespace fast_edi
