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
/// v is piecewise constant: m_k = exp(c_k) multiplies it at event k. The paper's counter weighting
/// replaces t by the index of the event in the frame and T by the number of events.
///
/// Method. Summation by parts over the clock u (time or counter) turns the integral into one update
/// per event that needs neither the previous event's clock nor an exp:
///
///     integral = v_n u_end - u_start + sum_k v_{k-1} (1 - m_k) u_k
///
/// v(f) counts the events in [start, f): an event exactly at the reference time comes after it.
///
/// State: two doubles per pixel (the sum, and v), and v at the reference time.
///
/// Running ahead. expect() names the window of the coming frame; follow() folds its events in as
/// they come, short of the window's ends. close() with the true window does what is left: events
/// near the ends, and a sweep over the pixels. When the prediction was wrong, close() starts anew
/// from the log ("surprise").
///
/// Canonical order, so that the result does not depend on how it was reached, bit for bit: forward
/// sums start at a base instant that is a function of the window alone (see baseInstant()),
/// and events between start and base are prepended in reverse time order,
///
///     sum <- m sum + (1 - m) u,   v_n <- m v_n,   v_f <- m v_f.
///
/// A prediction that is off by microseconds has the same base instant except near a multiple of
/// its quantum; then, too, close() starts anew.
///
/// Numerics. Everything in double; error about 1e-16 * (sum of |v_{k-1} (1 - m_k)| u_k) against the
/// integral, far below 1e-4 relative for a million events of one pixel. A value that leaves the
/// range of double (some 2700 net events of one polarity) makes the pixel's gain 1: see close().
/// Gains are kept within [kMinGain, kMaxGain], far beyond what any image can show.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "fast_edi/core/contrast_threshold.hpp"
#include "fast_edi/core/pixel_event_lists.hpp"
#include "fast_edi/core/types.hpp"

namespace fast_edi {

/// How a window was closed, for diagnostics and tests; the result is the same.
enum class CloseKind {
  kFollowed,  ///< running sums were used
  kSurprise,  ///< the window's events were walked
};

struct CloseReport {
  CloseKind kind = CloseKind::kSurprise;
  std::uint64_t events = 0;      ///< events inside the window
  std::uint64_t walked = 0;      ///< events handled by close() itself
  std::size_t out_of_range = 0;  ///< pixels whose value left the range of double
};

struct PixelSums;
struct EventFactors;

class DoubleIntegral {
 public:
  static constexpr double kMinGain = 1e-30;
  static constexpr double kMaxGain = 1e30;

  /// \throws std::invalid_argument unless both thresholds are finite and > 0
  DoubleIntegral(SensorSize size, ContrastThresholds thresholds, Weighting weighting);
  ~DoubleIntegral();
  DoubleIntegral(const DoubleIntegral&) = delete;
  DoubleIntegral& operator=(const DoubleIntegral&) = delete;

  /// Names the window and reference time that the next close() will probably ask for, in event
  /// time. Forgets running sums of any other window.
  void expect(const ExposureInterval& window, std::int64_t reference_ns);
  /// Forgets running sums and expectation. Must be called when the lists were flushed or reset.
  void forget();
  /// Folds in what the lists hold of the expected window. Cheap when there is nothing to do.
  void follow(const PixelEventLists& lists);

  /// Computes gain = 1 / E(reference) for every pixel, row-major.
  ///
  /// A pixel without events has gain 1 exactly. A pixel whose value left the range of double gets
  /// gain 1 and is counted in the report.
  /// \param window in event time; events outside it have no influence
  /// \param reference_ns in [window.start, window.end]
  /// \param gain pixelCount() floats, written
  /// \pre lists.size() equals the size given at construction; window.length() > 0
  CloseReport close(const PixelEventLists& lists, const ExposureInterval& window,
                    std::int64_t reference_ns, float* gain);

  /// Changes the thresholds; running sums start anew.
  void setThresholds(ContrastThresholds thresholds);
  ContrastThresholds thresholds() const { return thresholds_; }
  Weighting weighting() const { return weighting_; }
  /// Bytes of per-pixel state.
  std::size_t memoryBytes() const;

 private:
  /// The sequence numbers of a window's events.
  struct WindowEvents {
    std::uint64_t start;
    std::uint64_t base;       ///< first one at or after the base instant
    std::uint64_t reference;  ///< first one at or after the reference time
    std::uint64_t end;
  };

  static std::int64_t baseInstant(const ExposureInterval& window);
  bool runningSumsServe(const PixelEventLists& lists, const WindowEvents& events,
                        std::int64_t base_ns) const;
  void startAt(const PixelEventLists& lists, std::int64_t base_ns);
  void fold(const PixelEventLists& lists, std::uint64_t end_sequence);
  void takeReference();
  void extendReference(const PixelEventLists& lists, std::uint64_t end_sequence);
  void prepend(const PixelEventLists& lists, const WindowEvents& events);
  void clear();

  SensorSize size_;
  ContrastThresholds thresholds_;
  Weighting weighting_;
  std::unique_ptr<EventFactors> factors_;
  std::vector<PixelSums> sums_;
  std::vector<double> reference_value_;  ///< v at the reference time, once taken

  bool expecting_ = false;
  ExposureInterval expected_;
  std::int64_t expected_reference_ns_ = 0;

  bool clean_ = false;               ///< every pixel's result is that of no event
  bool started_ = false;             ///< the members below are in force
  std::int64_t base_ns_ = 0;         ///< forward sums start here
  std::uint64_t base_sequence_ = 0;  ///< first event at or after base_ns_
  std::uint64_t cursor_ = 0;         ///< next event to fold
  bool reference_taken_ = false;
  std::uint64_t reference_cursor_ = 0;  ///< next event that reference_value_ does not know of
};

}  // namespace fast_edi
