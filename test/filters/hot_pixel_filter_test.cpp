#include "fast_edi/filters/hot_pixel_filter.hpp"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

namespace fast_edi {
namespace {

constexpr SensorSize kSize{32, 24};
constexpr ContrastThresholds kThresholds{0.25, 0.25};
constexpr std::uint16_t kHotEvents = 30;  // 1 kHz for 30 ms

struct Scene {
  std::vector<float> level = std::vector<float>(kSize.pixelCount(), 140.0F);
  std::vector<std::uint16_t> counts = std::vector<std::uint16_t>(2 * kSize.pixelCount());

  static std::size_t index(int x, int y) { return static_cast<std::size_t>(y * kSize.width + x); }
  void add(int x, int y, std::uint16_t off, std::uint16_t on) {
    counts[2 * index(x, y)] = static_cast<std::uint16_t>(counts[2 * index(x, y)] + off);
    counts[2 * index(x, y) + 1] = static_cast<std::uint16_t>(counts[2 * index(x, y) + 1] + on);
  }
  std::size_t find(HotPixelFilter& filter) const {
    std::vector<float> count;
    for (std::size_t i = 0; i < kSize.pixelCount(); ++i) {
      count.push_back(static_cast<float>(counts[2 * i] + counts[2 * i + 1]));
    }
    return filter.find(level.data(), count.data(), {counts.data(), kThresholds});
  }
};

using Group = std::vector<std::pair<int, int>>;

Group column() {
  Group pixels;
  for (int y = 0; y < kSize.height; ++y) {
    pixels.emplace_back(12, y);
  }
  return pixels;
}

/// One, a pair, 2 x 2, 1 x 4, at the border, and a whole column.
const std::vector<Group>& groups() {
  static const std::vector<Group> all = {{{10, 10}},
                                         {{10, 10}, {11, 10}},
                                         {{10, 10}, {11, 10}, {10, 11}, {11, 11}},
                                         {{10, 10}, {11, 10}, {12, 10}, {13, 10}},
                                         {{0, 0}, {31, 23}},
                                         column()};
  return all;
}

TEST(HotPixelFilter, FindsHotPixelsAloneAndInGroups) {
  for (const Group& group : groups()) {
    for (const bool on : {false, true}) {
      for (const bool busy : {false, true}) {
        Scene scene;
        if (busy) {  // texture that moves: a few events everywhere
          for (std::size_t i = 0; i < kSize.pixelCount(); ++i) {
            scene.counts[2 * i] = static_cast<std::uint16_t>(i * 7 % 4);
            scene.counts[2 * i + 1] = static_cast<std::uint16_t>(i * 5 % 4);
          }
        }
        for (const auto& [x, y] : group) {
          scene.counts[2 * Scene::index(x, y)] = 0;
          scene.counts[2 * Scene::index(x, y) + 1] = 0;
          scene.add(x, y, on ? 1 : kHotEvents, on ? kHotEvents : 1);
        }
        HotPixelFilter filter(kSize);
        EXPECT_EQ(scene.find(filter), group.size()) << on << busy;
      }
    }
  }
}

TEST(HotPixelFilter, SomeEventsOfTheOtherPolarityDoNotHideThem) {
  Scene scene;
  scene.add(10, 10, 43, 0);
  scene.add(10, 11, 39, 6);  // as a real pair did
  HotPixelFilter filter(kSize);
  EXPECT_EQ(scene.find(filter), 2U);
}

TEST(HotPixelFilter, FillsThemFromTheirNeighbours) {
  for (const Group& group : groups()) {
    Scene scene;
    std::vector<float> plane(kSize.pixelCount(), 0.5F);
    for (const auto& [x, y] : group) {
      scene.add(x, y, 0, kHotEvents);
      plane[Scene::index(x, y)] = -3.0F;
    }
    HotPixelFilter filter(kSize);
    ASSERT_EQ(scene.find(filter), group.size());
    filter.fill(plane.data());
    EXPECT_EQ(plane, std::vector<float>(kSize.pixelCount(), 0.5F));
  }
}

TEST(HotPixelFilter, ForgetsThemWithTheNextFrame) {
  Scene scene;
  scene.add(10, 10, 0, kHotEvents);
  HotPixelFilter filter(kSize);
  ASSERT_EQ(scene.find(filter), 1U);
  ASSERT_EQ(Scene{}.find(filter), 0U);
  std::vector<float> plane(kSize.pixelCount(), 0.5F);
  plane[Scene::index(10, 10)] = -3.0F;
  filter.fill(plane.data());
  EXPECT_EQ(plane[Scene::index(10, 10)], -3.0F);
}

TEST(HotPixelFilter, AStrongEdgeThatMovesByAPixelIsNone) {
  Scene scene;
  for (int y = 0; y < kSize.height; ++y) {
    for (int x = 0; x < kSize.width; ++x) {
      scene.level[Scene::index(x, y)] = x < 16 ? 5.0F : 250.0F;
    }
    scene.level[Scene::index(16, y)] = 120.0F;
    scene.add(16, y, 0, 15);  // ln(250 / 5) / 0.25
  }
  HotPixelFilter filter(kSize);
  EXPECT_EQ(scene.find(filter), 0U);
}

TEST(HotPixelFilter, ALampThatStopsWithinTheExposureIsNone) {
  // 3 x 3 pixels of ten times the background's light crossed the frame and end at x = 20.
  Scene scene;
  for (int y = 10; y < 13; ++y) {
    for (int x = 2; x < 23; ++x) {
      scene.level[Scene::index(x, y)] = 180.0F;
      scene.add(x, y, x < 20 ? 9 : 0, 9);
    }
  }
  HotPixelFilter filter(kSize);
  EXPECT_EQ(scene.find(filter), 0U);
}

TEST(HotPixelFilter, LampsThatFlickerDoNotHideThem) {
  Scene scene;
  for (std::size_t i = 0; i < kSize.pixelCount(); ++i) {
    scene.counts[2 * i] = 6;
    scene.counts[2 * i + 1] = static_cast<std::uint16_t>(6 + i % 3);
  }
  scene.counts[2 * Scene::index(10, 10)] = 6;
  scene.counts[2 * Scene::index(10, 10) + 1] = 6 + kHotEvents;
  HotPixelFilter filter(kSize);
  EXPECT_EQ(scene.find(filter), 1U);
}

TEST(HotPixelFilter, AFlickeringPixelIsNone) {
  Scene scene;
  scene.add(10, 10, 40, 40);
  HotPixelFilter filter(kSize);
  EXPECT_EQ(scene.find(filter), 0U);
}

TEST(HotPixelFilter, ASmallDotUnderAMovingTextureIsNone) {
  // The dot stays dark while texture moves past it: events all around, hardly any within.
  Scene scene;
  for (std::size_t i = 0; i < kSize.pixelCount(); ++i) {
    scene.counts[2 * i] = 6;
    scene.counts[2 * i + 1] = 6;
  }
  for (const auto& [x, y] : Group{{10, 10}, {11, 10}, {10, 11}, {11, 11}}) {
    scene.level[Scene::index(x, y)] = 20.0F;
    scene.counts[2 * Scene::index(x, y)] = 0;
    scene.counts[2 * Scene::index(x, y) + 1] = 1;
  }
  HotPixelFilter filter(kSize);
  EXPECT_EQ(scene.find(filter), 0U);
}

}  // namespace
}  // namespace fast_edi
