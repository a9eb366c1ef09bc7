#include "reblur/event_changes.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "support/event_generators.hpp"

namespace fast_edi {
namespace {

constexpr SensorSize kSize{16, 12};
constexpr std::int64_t kMs = kNanosecondsPerMillisecond;
constexpr ExposureInterval kWindow{10 * kMs, 30 * kMs};

/// The same from the gains at each instant: log(gain(t) / gain(mid)).
TEST(EventChangesTest, AreTheLogRatiosOfTheGains) {
  const std::vector<Event> list =
      testing::makeEvents(testing::EventScene::kUniform, {kSize, 3000, 0, 40 * kMs, 1});
  PixelEventLists lists(kSize, {});
  lists.keepIntervals(true);
  lists.append(testing::wireView(testing::toWire(list)));
  const LatentGains::Model model{{0.3, 0.25}, {4 * kMs, 0.85}};
  EventChanges changes;
  changes.measure(lists, kWindow, model);

  LatentGains gains;
  const std::vector<float> ones(kSize.pixelCount(), 1.0F);
  gains.start(ones.data(), lists, {20 * kMs, kWindow.end_ns}, model);
  std::vector<float> gain(kSize.pixelCount());
  for (std::size_t k = 0; k < EventChanges::kInstants; ++k) {
    const auto t_ns =
        20 * kMs + static_cast<std::int64_t>(EventChanges::kTau[k] * static_cast<float>(10 * kMs));
    gains.at(lists, {t_ns, kWindow.end_ns}, gain.data());
    for (std::size_t i = 0; i < gain.size(); ++i) {
      ASSERT_NEAR(changes.at(k)[i], std::log(gain[i]), 1e-4F) << k << ", pixel " << i;
    }
  }
}

}  // namespace
}  // namespace fast_edi
