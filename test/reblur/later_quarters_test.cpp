#include "reblur/later_quarters.hpp"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "support/event_generators.hpp"

namespace fast_edi {
namespace {

constexpr SensorSize kSize{8, 6};
constexpr std::int64_t kMs = kNanosecondsPerMillisecond;
constexpr ExposureInterval kWindow{10 * kMs, 30 * kMs};

class LaterQuartersTest : public ::testing::Test {
 protected:
  LaterQuartersTest() {
    list = testing::makeEvents(testing::EventScene::kUniform, {kSize, 3000, 0, 40 * kMs, 1});
    list.push_back({1, 2, 20 * kMs, true});  // exactly at the cuts
    list.push_back({1, 2, 25 * kMs, true});
    list.push_back({1, 2, 30 * kMs, true});
    std::stable_sort(list.begin(), list.end(),
                     [](const Event& a, const Event& b) { return a.t_ns < b.t_ns; });
    lists.append(testing::wireView(testing::toWire(list)));
  }

  void expectCounts(const EventCounts& counts, std::int64_t from_ns, std::int64_t to_ns) const {
    std::vector<std::uint16_t> expected(2 * kSize.pixelCount());
    for (const Event& event : list) {
      const std::size_t pixel = std::size_t{event.y} * kSize.width + event.x;
      expected[2 * pixel + (event.on ? 1 : 0)] += event.t_ns >= from_ns && event.t_ns < to_ns;
    }
    EXPECT_EQ(std::vector<std::uint16_t>(counts.data(), counts.data() + expected.size()), expected);
  }

  std::vector<Event> list;
  PixelEventLists lists{kSize, {}};
  LaterQuarters quarters{kSize};
};

TEST_F(LaterQuartersTest, HoldTheEventsFromTheMiddleOnInTwoParts) {
  EXPECT_EQ(LaterQuarters::lateInstant(kWindow), 25 * kMs);
  quarters.count(lists, kWindow);
  expectCounts(quarters.third(), 20 * kMs, 25 * kMs);
  expectCounts(quarters.fourth(), 25 * kMs, 30 * kMs);
}

TEST_F(LaterQuartersTest, DoNotDependOnWhatWasPredicted) {
  quarters.accumulate(lists, {9 * kMs, 31 * kMs});
  quarters.count(lists, kWindow);
  expectCounts(quarters.third(), 20 * kMs, 25 * kMs);
  expectCounts(quarters.fourth(), 25 * kMs, 30 * kMs);
  quarters.reset();
  expectCounts(quarters.third(), 0, 0);
  expectCounts(quarters.fourth(), 0, 0);
  EXPECT_GT(quarters.memoryBytes(), 8 * kSize.pixelCount() - 1);
}

}  // namespace
}  // namespace fast_edi
