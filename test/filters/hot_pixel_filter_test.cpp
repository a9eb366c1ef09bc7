#include "fast_edi/filters/hot_pixel_filter.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
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
  std::size_t find(HotPixelFilter& filter, const ContrastThresholds& thresholds) const {
    std::vector<float> count;
    for (std::size_t i = 0; i < kSize.pixelCount(); ++i) {
      count.push_back(static_cast<float>(counts[2 * i] + counts[2 * i + 1]));
    }
    return filter.find(level.data(), count.data(), {counts.data(), thresholds});
  }
  std::size_t find(HotPixelFilter& filter) const { return find(filter, kThresholds); }
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

/// How many are found where one pixel has these events and all else is still and even.
std::size_t foundOfOne(std::uint16_t off, std::uint16_t on, const ContrastThresholds& thresholds) {
  Scene scene;
  scene.add(10, 10, off, on);
  HotPixelFilter filter(kSize);
  return scene.find(filter, thresholds);
}

TEST(HotPixelFilter, HaveSixEventsOrMore) {
  EXPECT_EQ(foundOfOne(0, 6, {0.4, 0.4}), 1U);
  EXPECT_EQ(foundOfOne(6, 0, {0.4, 0.4}), 1U);
  EXPECT_EQ(foundOfOne(0, 5, {0.4, 0.4}), 0U);
}

TEST(HotPixelFilter, HaveAtMostAQuarterOfTheOtherPolarity) {
  EXPECT_EQ(foundOfOne(2, 6, {0.5, 0.5}), 1U);
  EXPECT_EQ(foundOfOne(6, 2, {0.5, 0.5}), 1U);
  EXPECT_EQ(foundOfOne(4, 11, {0.5, 0.5}), 0U);
  EXPECT_EQ(foundOfOne(11, 4, {0.5, 0.5}), 0U);
}

TEST(HotPixelFilter, ChangeByMoreThanTheRangeAndOneAndAHalf) {
  EXPECT_EQ(foundOfOne(0, 6, {0.25, 0.5}), 0U);
  EXPECT_EQ(foundOfOne(0, 7, {0.25, 0.5}), 1U);
  EXPECT_EQ(foundOfOne(6, 0, {0.5, 0.25}), 0U);
  EXPECT_EQ(foundOfOne(7, 0, {0.5, 0.25}), 1U);
  EXPECT_EQ(foundOfOne(2, 8, {0.2, 0.07}), 0U) << "0.2 x 8 - 0.07 x 2 = 1.46";
  EXPECT_EQ(foundOfOne(2, 8, {0.2, 0.04}), 1U) << "0.2 x 8 - 0.04 x 2 = 1.52";
}

TEST(HotPixelFilter, ComparesThemWithTheRangeOfSevenBySevenPixels) {
  constexpr int kFarthest_px = 3;
  for (const int dy : {-4, -3, 0, 3, 4}) {
    for (const int dx : {-4, -3, 0, 3, 4}) {
      Scene scene;
      scene.level.assign(kSize.pixelCount(), 8.0F);
      scene.level[Scene::index(10 + dx, 10 + dy)] = 0.0F;  // ln((8 + 2) / (0 + 2)) = 1.61
      scene.add(10, 10, 0, 12);
      HotPixelFilter filter(kSize);
      const bool is_near = std::abs(dx) <= kFarthest_px && std::abs(dy) <= kFarthest_px;
      // 3.10 and 3.12; the range and 1.5 are 3.11.
      EXPECT_EQ(scene.find(filter, {0.2584, 0.2584}), is_near ? 0U : 1U) << dx << ", " << dy;
      EXPECT_EQ(scene.find(filter, {0.26, 0.26}), 1U) << dx << ", " << dy;
      scene.level[Scene::index(10 + dx, 10 + dy)] = 48.0F;  // as much above
      EXPECT_EQ(scene.find(filter, {0.2584, 0.2584}), is_near ? 0U : 1U) << dx << ", " << dy;
      EXPECT_EQ(scene.find(filter, {0.26, 0.26}), 1U) << dx << ", " << dy;
    }
  }
}

/// A hot pixel may have six like it in the 7 x 7 about it.
TEST(HotPixelFilter, AreFewOfTheirKind) {
  const Group around = {{7, 7}, {13, 7}, {7, 13}, {13, 13}, {10, 7}, {7, 10}, {13, 10}};
  struct Kind {
    std::uint16_t off;
    std::uint16_t on;
    bool alike;
  };
  for (const Kind& kind : {Kind{0, 10, true},   // a third of the change
                           {0, 9, false},       // less
                           {15, 15, true},      // as many events
                           {15, 14, false}}) {  // fewer
    Scene scene;
    scene.add(10, 10, 0, kHotEvents);
    for (std::size_t count = 0; count <= around.size(); ++count) {
      if (count > 0) {
        scene.add(around[count - 1].first, around[count - 1].second, kind.off, kind.on);
      }
      HotPixelFilter filter(kSize);
      scene.find(filter);
      std::vector<float> plane(kSize.pixelCount(), 0.0F);
      plane[Scene::index(10, 10)] = 1.0F;
      filter.fill(plane.data());
      EXPECT_EQ(plane[Scene::index(10, 10)], kind.alike && count > 6 ? 1.0F : 0.0F)
          << count << " of " << kind.off << ", " << kind.on;
    }
  }
}

/// What surrounds them on the nearest ring, at borders, too, where rings are cut.
TEST(HotPixelFilter, FillsThemWithTheMeanOfTheNearestRing) {
  std::vector<float> values;
  for (std::size_t i = 0; i < kSize.pixelCount(); ++i) {
    values.push_back(static_cast<float>(i * i % 97));
  }
  Group block;  // its middle has no other within one pixel
  for (int y = 10; y < 13; ++y) {
    for (int x = 9; x < 11; ++x) block.emplace_back(x, y);
  }
  const Group corner = {{0, 0}, {1, 0}, {0, 1}, {1, 1}};
  for (const Group& group :
       {Group{{10, 10}}, Group{{31, 23}}, Group{{0, 12}, {31, 12}}, Group{{12, 0}, {12, 23}},
        Group{{30, 22}, {31, 22}, {30, 23}, {31, 23}}, block, corner}) {
    Scene scene;
    std::vector<bool> is_hot(kSize.pixelCount());
    for (const auto& [x, y] : group) {
      scene.add(x, y, 0, kHotEvents);
      is_hot[Scene::index(x, y)] = true;
    }
    HotPixelFilter filter(kSize);
    ASSERT_EQ(scene.find(filter), group.size());
    std::vector<float> filled = values;
    filter.fill(filled.data());
    for (const auto& [x, y] : group) {
      double sum = 0.0;
      int others = 0;
      for (int ring = 1; others == 0; ++ring) {
        for (int v = std::max(0, y - ring); v <= std::min(kSize.height - 1, y + ring); ++v) {
          for (int u = std::max(0, x - ring); u <= std::min(kSize.width - 1, x + ring); ++u) {
            if (is_hot[Scene::index(u, v)]) continue;
            sum += static_cast<double>(values[Scene::index(u, v)]);
            ++others;
          }
        }
      }
      EXPECT_NEAR(static_cast<double>(filled[Scene::index(x, y)]), sum / others, 1e-4)
          << x << ", " << y;
      values[Scene::index(x, y)] = filled[Scene::index(x, y)];
    }
    EXPECT_EQ(filled, values) << "nothing else";
  }
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
