/// \file
/// The parameters in force: those of the user with the thresholds and the event delay that
/// OnlineCalibration has learned from the frames so far.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "calibration/online_calibration.hpp"
#include "fast_edi/base/deblur_counters.hpp"
#include "fast_edi/events/event_stream.hpp"
#include "fast_edi/parameters/parameters.hpp"

namespace fast_edi {

class ParameterRefinement {
 public:
  explicit ParameterRefinement(const DeblurParameters& parameters)
      : requested_(parameters), in_force_(parameters) {
    apply(given());
  }

  /// By the user.
  const DeblurParameters& requested() const { return requested_; }
  /// The same object throughout.
  const DeblurParameters& inForce() const { return in_force_; }
  /// The delay of events, part of inForce().time_offset_ns.
  std::int64_t eventDelay() const { return in_force_.time_offset_ns - requested_.time_offset_ns; }

  /// Pairs of frames that inForce() was learned from; 0: it is what was given.
  int learnedPairs() const { return calibration_ ? calibration_->fits() : 0; }

  /// Keeps what was learned unless it would be learned differently now.
  void setParameters(const DeblurParameters& parameters);
  /// Events were lost: discards what was learned and restarts from the given values.
  void reset();

  /// True when the frame that is about to be deblurred is needed.
  bool wantsFrame() const;
  /// Keeps a copy of its gains, before any filter touches them.
  void keepGains(const std::vector<float>& gains) { gains_ = gains; }
  /// Learns from that frame and the one before it.
  /// \param window, reference_ns in event time
  void learn(const ImageView& blurry, const ExposureInterval& window, std::int64_t reference_ns,
             const EventStream& events, DeblurCounters& counters);
  /// Instead of learn() for a frame that is not needed.
  void skipFrame();
  /// A frame was not deblurred: the next one has no predecessor.
  void interrupt();

  /// The earliest event that the next frame needs for this, at most \p t_ns.
  std::int64_t neededFrom(std::int64_t t_ns) const;
  std::size_t memoryBytes() const;

 private:
  Calibration given() const { return {requested_.thresholds, requested_.event_delay_ns}; }
  void apply(const Calibration& calibration);

  DeblurParameters requested_;
  DeblurParameters in_force_;
  std::optional<OnlineCalibration> calibration_;
  std::vector<float> gains_;
};

}  // namespace fast_edi
