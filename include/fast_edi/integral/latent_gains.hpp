/// \file
/// The gains of all pixels at any instant near an exposure, from those at one instant of it.
///
/// With B the blurry frame, f the reference time, v the latent value that a pixel's events give it
/// and L(f) = B / E(f) = B * gain(f) (see double_integral.hpp),
///
///     L(t) = L(f) * v(t) / v(f)    =>    gain(t) = gain(f) * v(t) / v(f)
///
/// and v(t) / v(f) is the product of exp(+c_on) and exp(-c_off) over the pixel's events between f
/// and t, inverted for t < f, and of what each pixel has gone of its next step at t, divided by the
/// same at f (see level_model.hpp). It holds inside the exposure, where gain(t) is 1 / E(t), and
/// beyond it as far as no event is missing. As everywhere, an event exactly at t comes after t.
///
/// Complexity. Each step costs O(events between the last instant and the next, and of one ramp's
/// length behind it, + pixels); a film of n images in order of time O(events + n * pixels). The
/// double integral itself is not computed again.
///
/// Numerics. One double for each pixel, one rounding for each event: equal to
/// DoubleIntegral::integrate() at that instant within 1e-6, apart from pixels that leave the range
/// of double there.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "fast_edi/base/contrast_threshold.hpp"
#include "fast_edi/base/level_model.hpp"
#include "fast_edi/events/pixel_event_lists.hpp"

namespace fast_edi {

class LatentGains {
 public:
  /// What an event means.
  struct Model {
    ContrastThresholds thresholds;
    LevelModel level;
  };

  /// Begins at a frame's reference time.
  /// \param gain lists.size().pixelCount() gains of DoubleIntegral::integrate(), not filtered;
  /// copied \param reference of the gains: the reference time and the end of the window, in event
  /// time
  void start(const float* gain, const PixelEventLists& lists, const LevelInstant& reference,
             const Model& model);

  /// Goes on, or back, to another instant.
  /// \param gain pixelCount floats, written, within [kMinGain, kMaxGain]
  /// \return events between both instants
  /// \pre start() was called; the lists, of the same size, hold all events between instant() and
  ///      \p to, and as far as they are to be known
  std::uint64_t at(const PixelEventLists& lists, const LevelInstant& to, float* gain);

  /// Instant of the last at() or start(), in event time.
  std::int64_t instant() const { return t_ns_; }
  std::size_t memoryBytes() const { return gain_.capacity() * sizeof(double); }

 private:
  std::int64_t t_ns_ = 0;
  Model model_;
  std::vector<double> gain_;  ///< at t_ns_, without the steps that have only begun
};

}  // namespace fast_edi
