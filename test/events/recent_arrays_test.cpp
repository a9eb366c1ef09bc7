#include "fast_edi/events/recent_arrays.hpp"

#include <vector>

#include <gtest/gtest.h>

#include "support/event_generators.hpp"

namespace fast_edi {
namespace {

std::vector<Event> eventsFrom(std::int64_t start_ns, std::size_t count) {
  std::vector<Event> events;
  for (std::size_t i = 0; i < count; ++i) {
    events.push_back(
        {static_cast<std::uint16_t>(i), 1, start_ns + static_cast<std::int64_t>(i), i % 2 == 0});
  }
  return events;
}

bool contains(const RecentArrays& arrays, const std::vector<Event>& events) {
  const auto bytes = testing::toWire(events);
  return arrays.contains(testing::wireView(bytes));
}

void add(RecentArrays& arrays, const std::vector<Event>& events) {
  const auto bytes = testing::toWire(events);
  arrays.add(testing::wireView(bytes));
}

TEST(RecentArrays, KnowAnArrayOfAnyLength) {
  for (const std::size_t count : {1, 2, 7, 8, 9, 1000}) {
    RecentArrays arrays;
    const std::vector<Event> events = eventsFrom(100, count);
    EXPECT_FALSE(contains(arrays, events));
    add(arrays, events);
    EXPECT_TRUE(contains(arrays, events));
    arrays.clear();
    EXPECT_FALSE(contains(arrays, events));
  }
}

TEST(RecentArrays, TellItFromOthers) {
  RecentArrays arrays;
  const std::vector<Event> events = eventsFrom(100, 8);
  add(arrays, events);
  EXPECT_FALSE(contains(arrays, eventsFrom(100, 9)));
  EXPECT_FALSE(contains(arrays, eventsFrom(101, 8)));
  for (std::size_t i = 0; i < events.size(); ++i) {
    std::vector<Event> other = events;
    other[i].on = !other[i].on;
    EXPECT_FALSE(contains(arrays, other)) << i;
    other = events;
    ++other[i].x;
    EXPECT_FALSE(contains(arrays, other)) << i;
  }
}

TEST(RecentArrays, ForgetTheOldest) {
  RecentArrays arrays;
  constexpr auto kMore = static_cast<std::int64_t>(RecentArrays::kArrays) + 1;
  for (std::int64_t i = 0; i < kMore; ++i) {
    add(arrays, eventsFrom(1000 * i, 3));
  }
  EXPECT_FALSE(contains(arrays, eventsFrom(0, 3)));
  for (std::int64_t i = 1; i < kMore; ++i) {
    EXPECT_TRUE(contains(arrays, eventsFrom(1000 * i, 3))) << i;
  }
}

}  // namespace
}  // namespace fast_edi
