/// \file
/// The double integral of each frame and its state while events arrive: the predicted window, gains
/// and event counts of all pixels. Handles changes of size and flushes of the event lists.
///
/// Per-pixel memory is taken only once a frame of the sensor's size has come, so that a nonsensical
/// size in an event array costs nothing.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "fast_edi/base/types.hpp"
#include "fast_edi/events/event_counts.hpp"
#include "fast_edi/events/event_stream.hpp"
#include "fast_edi/integral/double_integral.hpp"
#include "fast_edi/parameters/parameters.hpp"
#include "reblur/later_quarters.hpp"

namespace fast_edi {

class WindowIntegral {
 public:
  /// Which events of the window are counted.
  enum class Counting {
    kNone,
    kWindow,    ///< for the filters
    kQuarters,  ///< and those of its later quarters, for Reblur
  };
  static Counting countingFor(const DeblurParameters& parameters);

  /// Makes the integral fit the lists.
  /// \param may_allocate whether per-pixel memory may be taken
  /// \return false while it cannot be used
  /// \pre events.lists() is not null
  bool prepare(EventStream& events, const DeblurParameters& parameters, bool may_allocate);
  /// Changes thresholds, weighting and level model.
  void adopt(const DeblurParameters& parameters);
  void resetPrediction() { predicted_.reset(); }

  // All of them need \pre prepare() was true.

  /// Names the next window, in event time. Running sums stay while it is near the one named before.
  void predictWindow(const ExposureInterval& window, std::int64_t reference_ns);
  /// Folds in the events that have come, and counts them.
  void accumulate(const PixelEventLists& lists, Counting counting);
  /// Gains and event counts of a window, in event time.
  IntegrationReport integrate(const PixelEventLists& lists, const ExposureInterval& window,
                              std::int64_t reference_ns, Counting counting);

  /// Of the last window; filters work in place.
  std::vector<float>& gains() { return gains_; }
  const EventCounts& counts() const { return *counts_; }
  /// \pre they were counted
  const LaterQuarters& quarters() const { return *quarters_; }
  std::size_t memoryBytes() const;

 private:
  struct Prediction {
    ExposureInterval window;
    std::int64_t reference_ns = 0;
  };
  static bool areNear(const Prediction& a, const Prediction& b);
  void wantQuarters(Counting counting);

  std::unique_ptr<DoubleIntegral> integral_;
  SensorSize size_;
  std::uint64_t generation_ = 0;  ///< of the lists
  std::vector<float> gains_;
  std::optional<EventCounts> counts_;      ///< for the filters alone
  std::optional<LaterQuarters> quarters_;  ///< empty until they are wanted
  std::optional<Prediction> predicted_;
};

}  // namespace fast_edi
