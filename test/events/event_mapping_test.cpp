#include "fast_edi/events/event_mapping.hpp"

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "fast_edi/events/event_wire.hpp"
#include "support/event_generators.hpp"

namespace fast_edi {
namespace {

constexpr SensorSize kSize{5, 3};

using Pixel = std::pair<int, int>;

Pixel mapped(EventOrientation orientation, int x, int y) {
  const EventMapping mapping{EventPolarity::kNormal, orientation};
  const Event event = mapping.apply(
      Event{static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y), 7, true}, kSize);
  return {event.x, event.y};
}

/// What the words mean to an image of 5 x 3 pixels: where its corners go.
TEST(EventMapping, TurnsTheCornersAsTheWordsSay) {
  struct Corners {
    Pixel top_left, top_right, bottom_left, bottom_right;
  };
  const std::map<std::string, Corners> expected{
      {"normal", {{0, 0}, {4, 0}, {0, 2}, {4, 2}}},
      {"flip_x", {{4, 0}, {0, 0}, {4, 2}, {0, 2}}},
      {"flip_y", {{0, 2}, {4, 2}, {0, 0}, {4, 0}}},
      {"rotate_180", {{4, 2}, {0, 2}, {4, 0}, {0, 0}}},
      {"transpose", {{0, 0}, {0, 4}, {2, 0}, {2, 4}}},
      {"rotate_90", {{2, 0}, {2, 4}, {0, 0}, {0, 4}}},
      {"rotate_270", {{0, 4}, {0, 0}, {2, 4}, {2, 0}}},
      {"transverse", {{2, 4}, {2, 0}, {0, 4}, {0, 0}}},
  };
  ASSERT_EQ(expected.size(), kEventOrientations.size());
  for (const auto& [word, orientation] : kEventOrientations) {
    SCOPED_TRACE(word);
    const Corners& corners = expected.at(word);
    EXPECT_EQ(mapped(orientation, 0, 0), corners.top_left);
    EXPECT_EQ(mapped(orientation, 4, 0), corners.top_right);
    EXPECT_EQ(mapped(orientation, 0, 2), corners.bottom_left);
    EXPECT_EQ(mapped(orientation, 4, 2), corners.bottom_right);
    EXPECT_STREQ(toString(orientation), word);
  }
}

TEST(EventMapping, ExchangesWidthAndHeightWhereItExchangesTheAxes) {
  for (const auto& [word, orientation] : kEventOrientations) {
    SCOPED_TRACE(word);
    const EventMapping mapping{EventPolarity::kNormal, orientation};
    const bool exchanges = orientation >= EventOrientation::kTranspose;
    EXPECT_EQ(mapping.apply(kSize), exchanges ? (SensorSize{3, 5}) : kSize);
  }
}

TEST(EventMapping, TakesThePixelsOfTheSensorToThoseOfTheFrameAndNoOtherOnes) {
  constexpr int kBeyond = 65536;
  for (const auto& [word, orientation] : kEventOrientations) {
    SCOPED_TRACE(word);
    const SensorSize frame = EventMapping{EventPolarity::kNormal, orientation}.apply(kSize);
    std::map<Pixel, int> hits;
    for (const int x : {0, 1, 2, 3, 4, 5, 6, 32767, 32768, kBeyond - 1}) {
      for (const int y : {0, 1, 2, 3, 4, 32767, 32768, kBeyond - 1}) {
        const Pixel pixel = mapped(orientation, x, y);
        const bool inside = pixel.first < frame.width && pixel.second < frame.height;
        ASSERT_EQ(inside, x < kSize.width && y < kSize.height) << x << ", " << y;
        hits[pixel] += inside ? 1 : 0;
      }
    }
    std::size_t covered = 0;
    for (const auto& [pixel, count] : hits) {
      ASSERT_LE(count, 1);
      covered += static_cast<std::size_t>(count);
    }
    EXPECT_EQ(covered, kSize.pixelCount());
  }
}

TEST(EventMapping, InvertsThePolarityAndLeavesTheTime) {
  const EventMapping mapping{EventPolarity::kInverted, EventOrientation::kNormal};
  for (const bool on : {false, true}) {
    const Event event = mapping.apply(Event{2, 1, 123456789, on}, kSize);
    EXPECT_EQ(event.on, !on);
    EXPECT_EQ(event.t_ns, 123456789);
    EXPECT_EQ(event.x, 2);
    EXPECT_EQ(event.y, 1);
  }
}

TEST(EventMapping, DoesTheSameToWireRecords) {
  const std::vector<Event> events =
      testing::makeEvents(testing::EventScene::kUniform, {kSize, 200, 5'000, 1'000'000, 3});
  for (const EventPolarity polarity : {EventPolarity::kNormal, EventPolarity::kInverted}) {
    for (const auto& [word, orientation] : kEventOrientations) {
      SCOPED_TRACE(word);
      const EventMapping mapping{polarity, orientation};
      EXPECT_EQ(mapping.isIdentity(),
                polarity == EventPolarity::kNormal && orientation == EventOrientation::kNormal);
      std::vector<std::uint8_t> records = testing::toWire(events);
      mapping.apply(records.data(), events.size(), kSize);
      std::vector<Event> expected;
      for (const Event& event : events) {
        expected.push_back(mapping.apply(event, kSize));
      }
      EXPECT_EQ(records, testing::toWire(expected));
    }
  }
}

}  // namespace
}  // namespace fast_edi
