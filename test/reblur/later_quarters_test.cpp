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
    list_ = testing::makeEvents(testing::EventScene::kUniform, {kSize, 3000, 0, 40 * kMs, 1});
    list_.push_back({1, 2, 20 * kMs, true});  // exactly at the cuts
    list_.push_back({1, 2, 25 * kMs, true});
    list_.push_back({1, 2, 30 * kMs, true});
    std::stable_sort(list_.begin(), list_.end(),
                     [](const Event& a, const Event& b) { return a.t_ns < b.t_ns; });
    lists_.append(testing::wireView(testing::toWire(list_)));
  }

  void expectCounts(const EventCounts& counts, std::int64_t from_ns, std::int64_t to_ns) const {
    std::vector<std::uint16_t> expected(2 * kSize.pixelCount());
    for (const Event& event : list_) {
      const std::size_t pixel = std::size_t{event.y} * kSize.width + event.x;
      expected[2 * pixel + (event.on ? 1 : 0)] += event.t_ns >= from_ns && event.t_ns < to_ns;
    }
    EXPECT_EQ(std::vector<std::uint16_t>(counts.data(), counts.data() + expected.size()), expected);
  }

  std::vector<Event> list_;
  PixelEventLists lists_{kSize, {}};
  LaterQuarters quarters_{kSize};
};

TEST_F(LaterQuartersTest, HoldTheEventsFromTheMiddleOnInTwoParts) {
  EXPECT_EQ(LaterQuarters::lateInstant(kWindow), 25 * kMs);
  quarters_.count(lists_, kWindow);
  expectCounts(quarters_.third(), 20 * kMs, 25 * kMs);
  expectCounts(quarters_.fourth(), 25 * kMs, 30 * kMs);
}

TEST_F(LaterQuartersTest, DoNotDependOnWhatWasPredicted) {
  quarters_.accumulate(lists_, {9 * kMs, 31 * kMs});
  quarters_.count(lists_, kWindow);
  expectCounts(quarters_.third(), 20 * kMs, 25 * kMs);
  expectCounts(quarters_.fourth(), 25 * kMs, 30 * kMs);
  quarters_.reset();
  expectCounts(quarters_.third(), 0, 0);
  expectCounts(quarters_.fourth(), 0, 0);
  EXPECT_GT(quarters_.memoryBytes(), 8 * kSize.pixelCount() - 1);
}

}  // namespace
}  // namespace fast_edi
