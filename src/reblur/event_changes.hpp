/// \file
/// What the events say about the change of each pixel's log intensity from mid-exposure to three
/// other instants of the exposure.
///
/// Events were counted as they came: those of the whole exposure (EventCounts) and of the quarters
/// after its middle (LaterQuarters). Steps that have only begun at an instant (see level_model.hpp)
/// are added, too, except where pixels have so many events that a part of a step matters little.
///
/// Complexity. O(events within the longest ramp after the start, the middle and the third quarter +
/// pixels).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "fast_edi/base/types.hpp"
#include "fast_edi/events/pixel_event_lists.hpp"
#include "fast_edi/integral/latent_gains.hpp"
#include "reblur/later_quarters.hpp"

namespace fast_edi {

class EventChanges {
 public:
  static constexpr std::size_t kInstants = 3;
  /// tau of the instants, see ImageMotion.
  static constexpr std::array<float, kInstants> kTau = {-1.0F, 0.5F, 1.0F};
  /// Events per pixel, in the mean, from which on begun steps are left out.
  static constexpr std::uint64_t kManyEvents = 16;

  /// \param window of the exposure, in event time
  /// \param counts OFF and ON events of each pixel in the window, interleaved
  /// \param quarters of the same window and size
  /// \pre the lists keep intervals unless the level model is the staircase
  void measure(const PixelEventLists& lists, const ExposureInterval& window,
               const std::uint16_t* counts, const LaterQuarters& quarters,
               const LatentGains::Model& model);

  /// log L(x, tau) - log L(x, 0) of all pixels, row-major.
  const std::vector<float>& at(std::size_t instant) const { return change_[instant]; }

  /// The same at half the resolution: means over 2 x 2 pixels.
  const std::vector<float>& halvedAt(std::size_t instant) const { return halved_[instant]; }

  std::size_t memoryBytes() const;

 private:
  void addBegunSteps(const PixelEventLists& lists, const ExposureInterval& window,
                     const LatentGains::Model& model);

  std::vector<float> middle_;  ///< scratch: steps that have begun in the middle
  std::array<std::vector<float>, kInstants> change_;
  std::array<std::vector<float>, kInstants> halved_;
};

}  // namespace fast_edi
