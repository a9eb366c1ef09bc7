/// \file
/// The integral of every pixel's latent value over one interval, kept up while events come.
///
/// With v(t) = exp(integral_start^t e(s) ds) relative to the interval's start, m_k = exp(c_k) the
/// multiplier of event k and u the clock (time or counter), summation by parts gives
///
///     integral_start^end v du = v_n u_end - u_start + sum_k v_{k-1} (1 - m_k) u_k
///
/// so that an event needs one update, without the clock of the one before it and without an exp.
///
/// Ramps (see level_model.hpp) add sum_k v_{k-1} (K_k - 1) r_k. A ramp counts whole, in the
/// interval that its event lies in; what of it lies before the start is for the caller to settle.
///
/// Canonical order. Forward sums start at a base instant, a function of the interval alone: the
/// first multiple of a quantum that lies a margin after the start. Events between start and base
/// are prepended in reverse order when the interval is closed,
///
///     sum <- m sum + (1 - m) u + (K - 1) r,   v_n <- m v_n.
///
/// So a predicted interval that was off by microseconds leads to the same operations in the same
/// order as none at all, unless a multiple of the quantum lies between the two starts; then the
/// sums restart.
#pragma once

#include <cstdint>
#include <vector>

#include "fast_edi/base/types.hpp"
#include "fast_edi/events/pixel_event_lists.hpp"
#include "integral/fold_kernel.hpp"
#include "integral/gain_kernel.hpp"

namespace fast_edi {

class RunningIntegral {
 public:
  explicit RunningIntegral(std::size_t pixels) : sums_(pixels, PixelSums{0.0, 1.0}) {}

  /// Predicts the interval of the next integrate(); sums of any other are discarded.
  void predictInterval(const ExposureInterval& interval);
  /// Discards sums and prediction.
  void reset();
  /// Folds in what the lists hold of the predicted interval, short of its ends.
  void accumulate(const PixelEventLists& lists, const EventFactors& factors, Weighting weighting);

  struct Result {
    IntervalClock clock;       ///< for sums()
    bool predicted = false;    ///< the running sums were of use
    std::uint64_t walked = 0;  ///< events handled by this call
  };

  /// Completes the sums of an interval: integral = sum + value * clock.end - clock.start. After
  /// that they must be taken (see takeGains(), which resets them) and markSumsTaken() be called.
  Result integrate(const PixelEventLists& lists, const ExposureInterval& interval,
                   const EventFactors& factors, Weighting weighting);
  PixelSums* sums() { return sums_.data(); }
  void markSumsTaken();

  std::size_t memoryBytes() const { return sums_.capacity() * sizeof(PixelSums); }

 private:
  void clear();
  void restartAt(const PixelEventLists& lists, std::int64_t base_ns);
  void fold(const PixelEventLists& lists, std::uint64_t end, const EventFactors& factors,
            Weighting weighting);
  void prepend(const PixelEventLists& lists, std::uint64_t begin, const EventFactors& factors,
               Weighting weighting);

  std::vector<PixelSums> sums_;
  bool has_prediction_ = false;
  ExposureInterval predicted_;
  bool clean_ = true;                ///< all sums are those of no event
  bool started_ = false;             ///< the members below are in force
  std::int64_t base_ns_ = 0;         ///< forward sums start here
  std::uint64_t base_sequence_ = 0;  ///< first event at or after base_ns_
  std::uint64_t cursor_ = 0;         ///< next event to fold
};

}  // namespace fast_edi
