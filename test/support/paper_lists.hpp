/// \file
/// The list method as published (Lin et al., ICRA 2023), for reading pairs off it and as the speed
/// baseline: one std::vector of <time, exp value, counter> for each pixel, all in double.
///
/// Step 1, while events come and nothing is known about exposures: one exp() and one entry for each
/// event. Step 2, when a frame is closed: for each list, sum exp value x difference of consecutive
/// counters (or times) inside the window, divide by the value at the reference time. Then entries
/// before the window's end are dropped; vectors keep their capacity.
///
/// The window's first and last counter are known only after all lists were seen, so a list's sum is
/// split into what needs them and what does not:
///
///     sum = [v_0 u_1 + v_1 (u_2 - u_1) + ... - v_n u_n] - v_0 u_start + v_n u_end
///
/// Borders and normalisation as in reference_double_integral.hpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "fast_edi/base/contrast_threshold.hpp"
#include "fast_edi/base/types.hpp"
#include "fast_edi/events/event_wire.hpp"

namespace fast_edi::testing {

class PaperLists {
 public:
  struct Entry {
    double t = 0.0;          ///< sensor time since the first event [ns]
    double exp_value = 1.0;  ///< latent value from this event on
    double counter = 0.0;    ///< events anywhere before this one
  };

  PaperLists(SensorSize size, ContrastThresholds thresholds, Weighting weighting);

  /// Step 1. Events outside the sensor are left out. \pre times never decrease
  void add(const Event& event);
  void add(const WireEvents& events);

  /// Step 2: E(reference) of every pixel, and drops entries before the window's end.
  const std::vector<double>& close(const ExposureInterval& window, std::int64_t reference_ns);
  /// close(), then the latent image. Both images have pixelCount() bytes, row-major.
  void close(const ExposureInterval& window, std::int64_t reference_ns, const std::uint8_t* blurry,
             std::uint8_t* latent);

  /// Entries of one pixel's list that are still there.
  const std::vector<Entry>& list(int x, int y) const;
  /// Bytes allocated by the lists.
  std::size_t memoryBytes() const;

 private:
  struct PixelList {
    std::vector<Entry> entries;
    double level = 0.0;         ///< log intensity after the last entry
    double value_before = 1.0;  ///< latent value before the first entry
  };
  /// What a list contributes, see the equation above.
  struct Partial {
    double sum = 0.0;
    double first_value = 1.0;
    double last_value = 1.0;
    double reference_value = 1.0;
  };

  Partial walk(const PixelList& list, double start, double end, double reference);
  static void dropBefore(PixelList& list, double end);

  SensorSize size_;
  ContrastThresholds thresholds_;
  Weighting weighting_;
  std::vector<PixelList> lists_;
  std::vector<Partial> partials_;
  std::vector<double> double_integral_;
  double counter_ = 0.0;
  double first_counter_ = 0.0;  ///< of the window being closed
  double end_counter_ = 0.0;
  std::int64_t base_ns_ = 0;
  bool has_base_ = false;
};

}  // namespace fast_edi::testing
