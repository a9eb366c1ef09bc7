/// \file
/// What the events say about the change of each pixel's log intensity from mid-exposure to four
/// other instants of the exposure.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "fast_edi/base/types.hpp"
#include "fast_edi/events/pixel_event_lists.hpp"
#include "fast_edi/integral/latent_gains.hpp"

namespace fast_edi {

class EventChanges {
 public:
  static constexpr std::size_t kInstants = 4;
  /// tau of the instants, see ImageMotion.
  static constexpr std::array<float, kInstants> kTau = {-1.0F, -0.5F, 0.5F, 1.0F};

  /// Sums up the steps of all events, and those that have only begun (see level_model.hpp).
  /// \param window of the exposure, in event time
  /// \pre the lists keep intervals unless the level model is the staircase
  void measure(const PixelEventLists& lists, const ExposureInterval& window,
               const LatentGains::Model& model);

  /// log L(x, tau) - log L(x, 0) of all pixels, row-major.
  const std::vector<float>& at(std::size_t instant) const { return change_[instant]; }

  std::size_t memoryBytes() const;

 private:
  std::vector<float> sum_;
  std::vector<float> middle_;
  std::array<std::vector<float>, kInstants> change_;
};

}  // namespace fast_edi
