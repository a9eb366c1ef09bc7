/// \file
/// The double integral of every pixel over an exposure window, kept up while events come.
///
/// Equations (Pan et al., CVPR 2019; Lin et al., ICRA 2023). With e(s) the pixel's events as
/// impulses of height +c_on or -c_off, v(t) = exp(integral_start^t e(s) ds) the latent value
/// relative to the exposure's start, [start, end) the exposure of length T and f the reference
/// time,
///
///     E(f) = 1/T * integral_start^end v(t) dt / v(f)        L(f) = B / E(f) = B * gain
///
/// In plain EDI v is piecewise constant: m_k = exp(c_k) multiplies it at event k. The paper's
/// counter weighting replaces t by the index of the event in the frame and T by the number of
/// events.
///
/// v(f) counts the events in [start, f): an event exactly at the reference time comes after it.
///
/// With a LevelModel, v rises towards each event (level_model.hpp). Ramps follow from the events of
/// the window and from the time of each pixel's last event before it; of events at or after its end
/// nothing is known when it is closed.
///
/// Method. The window is cut at f. With A the integral over [start, f) and B the one over [f, end),
/// the latter relative to f, E(f) = (A / v(f) + B) / T. Both are running sums (16 bytes per pixel,
/// see running_integral.hpp) that events are folded into as they arrive. An event's ramp counts
/// whole in the part that contains the event: a ramp across f belongs to a pixel without events
/// between the ramp's start and f, so in either part it is relative to the same value. Two sweeps
/// correct this at the ends: over the events of the first tau of the window, whose ramps began
/// before it, and over those of the time after f, for the fraction of its next step that a pixel
/// has already made at f.
///
/// Prediction. predictWindow() names the window of the coming frame; accumulate() folds its events
/// in as they arrive, except those close to the ends. integrate() with the true window then has
/// little left to do: the events near the ends and near the reference time, and one pass over the
/// pixels. If the prediction was wrong, integrate() restarts from the log. The result is the same
/// bit for bit, however it was reached, and depends neither on packets nor on earlier frames.
///
/// Complexity. accumulate() O(new events). integrate() O(events within a millisecond or so +
/// pixels) if the window was predicted, else O(events in the window + pixels). This pays off for
/// periodic exposures, which cameras have; if every exposure differs by more than microseconds from
/// the previous one, events are folded twice.
///
/// Numerics. Everything in double; error about 1e-16 * (sum of |v_{k-1} (1 - m_k)| u_k) against the
/// integral, far below 1e-4 relative for a million events of one pixel. A value that leaves the
/// range of double (some 2700 net events of one polarity) makes the pixel's gain 1: see
/// integrate(). Gains are kept within [kMinGain, kMaxGain], far beyond what any image can show. Not
/// covered: a pixel that climbs by more than some 100 net events and back within one and the same
/// time stamp; no sensor does that, and its gain is then finite but wrong.
#pragma once

#include <cstdint>
#include <memory>

#include "fast_edi/base/contrast_threshold.hpp"
#include "fast_edi/base/level_model.hpp"
#include "fast_edi/base/types.hpp"
#include "fast_edi/events/pixel_event_lists.hpp"

namespace fast_edi {

/// How a window was integrated, for diagnostics and tests; the result is the same.
enum class IntegrationKind {
  kPredicted,     ///< running sums were used
  kNotPredicted,  ///< all events of the window were folded
};

struct IntegrationReport {
  IntegrationKind kind = IntegrationKind::kNotPredicted;
  std::uint64_t events = 0;      ///< events inside the window
  std::uint64_t walked = 0;      ///< events folded by integrate() itself
  std::size_t out_of_range = 0;  ///< pixels whose value left the range of double
};

class DoubleIntegral {
 public:
  /// \param level of time weighting; counter weighting has the staircase
  /// \throws std::invalid_argument unless both thresholds are finite and > 0
  DoubleIntegral(SensorSize size, ContrastThresholds thresholds, Weighting weighting,
                 LevelModel level = {});
  ~DoubleIntegral();
  DoubleIntegral(const DoubleIntegral&) = delete;
  DoubleIntegral& operator=(const DoubleIntegral&) = delete;

  /// Predicts window and reference time of the next integrate(), in event time. Running sums of any
  /// other window are discarded.
  void predictWindow(const ExposureInterval& window, std::int64_t reference_ns);
  /// Discards running sums and prediction. Must be called when the lists were flushed or reset.
  void reset();
  /// Folds in what the lists hold of the predicted window. Cheap when there is nothing to do.
  void accumulate(const PixelEventLists& lists);

  /// Computes gain = 1 / E(reference) for every pixel, row-major.
  ///
  /// A pixel without events has gain 1 exactly. A pixel whose value left the range of double gets
  /// gain 1 and is counted in the report.
  /// \param window in event time; events outside it have no influence
  /// \param reference_ns in [window.start, window.end]
  /// \param gain pixelCount() floats, written
  /// \pre lists.size() equals the size given at construction; window.length() > 0; unless the level
  ///      model is the staircase, the lists keep intervals, as for accumulate()
  IntegrationReport integrate(const PixelEventLists& lists, const ExposureInterval& window,
                              std::int64_t reference_ns, float* gain);

  /// Changes the thresholds; running sums restart.
  void setThresholds(ContrastThresholds thresholds);
  ContrastThresholds thresholds() const { return thresholds_; }
  Weighting weighting() const { return weighting_; }
  const LevelModel& level() const { return level_; }
  /// Bytes of per-pixel state.
  std::size_t memoryBytes() const;

 private:
  struct State;

  void cutRampsAtStart(const PixelEventLists& lists, const ExposureInterval& window,
                       std::int64_t reference_ns);
  void addRampsAtReference(const PixelEventLists& lists, const ExposureInterval& window,
                           std::int64_t reference_ns, float* gain) const;

  SensorSize size_;
  ContrastThresholds thresholds_;
  Weighting weighting_;
  LevelModel level_;
  std::unique_ptr<State> state_;
};

}  // namespace fast_edi
