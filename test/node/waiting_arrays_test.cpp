#include "node/waiting_arrays.hpp"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <ros/callback_queue.h>

namespace fast_edi {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr std::size_t kManyArrays = 1000;
constexpr std::size_t kManyEvents = 1'000'000'000;

class WaitingArraysTest : public ::testing::Test {
 protected:
  WaitingArrays::LossHandler onLoss() {
    return [this](std::size_t events) { losses_.push_back(events); };
  }
  void add(WaitingArrays& arrays, int number, std::size_t events) {
    arrays.add(events, [this, number, memory = memory_] { delivered_.push_back(number); });
  }

  ros::CallbackQueue queue_;
  std::vector<int> delivered_;
  std::vector<std::size_t> losses_;
  std::shared_ptr<int> memory_ = std::make_shared<int>();  ///< that each waiting array holds
};

TEST_F(WaitingArraysTest, ComeFromTheQueueInTheOrderOfArrival) {
  WaitingArrays arrays(queue_, {kManyArrays, kManyEvents}, onLoss());
  for (int i = 0; i < 3; ++i) {
    add(arrays, i, 10);
  }
  EXPECT_THAT(delivered_, IsEmpty());
  queue_.callAvailable();
  EXPECT_THAT(delivered_, ElementsAre(0, 1, 2));
  EXPECT_THAT(losses_, IsEmpty());
}

TEST_F(WaitingArraysTest, BeyondTheEventsTheOldestGoAndTheirMemoryWithThem) {
  WaitingArrays arrays(queue_, {kManyArrays, 25}, onLoss());
  for (int i = 0; i < 1000; ++i) {
    add(arrays, i, 10);
    ASSERT_LE(memory_.use_count(), 1 + 2);
  }
  queue_.callAvailable();
  EXPECT_THAT(delivered_, ElementsAre(998, 999));
  EXPECT_THAT(losses_, ElementsAre(9980u));
  add(arrays, 1000, 10);
  queue_.callAvailable();
  EXPECT_THAT(delivered_, ElementsAre(998, 999, 1000));
  EXPECT_THAT(losses_, ElementsAre(9980u)) << "told twice";
}

TEST_F(WaitingArraysTest, BeyondTheNumberOfArraysTheOldestGo) {
  WaitingArrays arrays(queue_, {2, kManyEvents}, onLoss());
  for (int i = 0; i < 5; ++i) {
    add(arrays, i, 1);
  }
  queue_.callAvailable();
  EXPECT_THAT(delivered_, ElementsAre(3, 4));
  EXPECT_THAT(losses_, ElementsAre(3u));
}

TEST_F(WaitingArraysTest, AnotherLimitHoldsFromTheNextArrayOn) {
  WaitingArrays arrays(queue_, {kManyArrays, kManyEvents}, onLoss());
  for (int i = 0; i < 5; ++i) {
    add(arrays, i, 10);
  }
  arrays.limitEvents(30);
  add(arrays, 5, 10);
  queue_.callAvailable();
  EXPECT_THAT(delivered_, ElementsAre(3, 4, 5));
  EXPECT_THAT(losses_, ElementsAre(30u));
}

TEST_F(WaitingArraysTest, TheLastOneStaysHoweverLarge) {
  WaitingArrays arrays(queue_, {kManyArrays, 0}, onLoss());
  add(arrays, 0, 10);
  add(arrays, 1, 500);
  queue_.callAvailable();
  EXPECT_THAT(delivered_, ElementsAre(1));
  EXPECT_THAT(losses_, ElementsAre(10u));
}

TEST_F(WaitingArraysTest, NothingIsDeliveredAfterTheEnd) {
  {
    WaitingArrays arrays(queue_, {kManyArrays, kManyEvents}, onLoss());
    add(arrays, 0, 10);
  }
  queue_.callAvailable();
  EXPECT_THAT(delivered_, IsEmpty());
  EXPECT_EQ(memory_.use_count(), 1);
}

TEST_F(WaitingArraysTest, EveryEventIsDeliveredOrTold) {
  constexpr std::size_t kEvents = 10;
  constexpr std::size_t kArrays = 20'000;
  WaitingArrays arrays(queue_, {kManyArrays, 5 * kEvents}, onLoss());
  std::thread producer([&] {
    for (std::size_t i = 0; i < kArrays; ++i) {
      add(arrays, static_cast<int>(i), kEvents);
    }
  });
  std::size_t told = 0;
  while (told < kArrays * kEvents) {
    queue_.callAvailable();
    told = delivered_.size() * kEvents;
    for (const std::size_t events : losses_) {
      told += events;
    }
  }
  producer.join();
  EXPECT_EQ(told, kArrays * kEvents);
  EXPECT_TRUE(std::is_sorted(delivered_.begin(), delivered_.end()));
}

}  // namespace
}  // namespace fast_edi
