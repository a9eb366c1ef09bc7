#include "node/periodic_callback.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <future>
#include <optional>

#include <gtest/gtest.h>
#include <ros/callback_queue.h>
#include <ros/spinner.h>

#include "rostest/node_client.hpp"
#include "rostest/ros_process.hpp"

namespace fast_edi {
namespace {

const ros::WallDuration kPeriod(0.001);
/// Long enough for a destructor that does not wait.
constexpr std::chrono::milliseconds kPatience(100);

class PeriodicCallbackTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { test::requireRos(); }
  PeriodicCallbackTest() {
    nh_.setCallbackQueue(&queue_);
    spinner_.start();
  }

  ros::CallbackQueue queue_;
  ros::NodeHandle nh_;
  ros::AsyncSpinner spinner_{3, &queue_};
};

TEST_F(PeriodicCallbackTest, CallsAgainAndAgainOneAtATime) {
  std::atomic<int> count{0};
  std::atomic<int> at_work{0};
  std::atomic<int> most_at_work{0};
  const PeriodicCallback callback(nh_, kPeriod, [&] {
    most_at_work = std::max<int>(most_at_work, ++at_work);
    ++count;
    --at_work;
  });
  EXPECT_TRUE(test::waitUntil([&] { return count >= 10; }));
  EXPECT_EQ(most_at_work, 1);
}

TEST_F(PeriodicCallbackTest, ItsEndWaitsForACallAtWorkAndIsTheLastOfThem) {
  std::promise<void> begun;
  std::promise<void> end;
  std::atomic<int> count{0};
  std::atomic<bool> ended{false};
  std::optional<PeriodicCallback> callback;
  callback.emplace(nh_, kPeriod, [&] {
    if (++count == 1) {
      begun.set_value();
      end.get_future().wait();
      ended = true;
    }
  });
  begun.get_future().wait();
  const std::future<void> destruction =
      std::async(std::launch::async, [&callback] { callback.reset(); });
  EXPECT_EQ(destruction.wait_for(kPatience), std::future_status::timeout);
  end.set_value();
  destruction.wait();
  EXPECT_TRUE(ended);
  const int before = count;
  std::atomic<int> others{0};
  const PeriodicCallback other(nh_, kPeriod, [&others] { ++others; });
  EXPECT_TRUE(test::waitUntil([&others] { return others >= 3; }));
  EXPECT_EQ(count, before);
}

TEST_F(PeriodicCallbackTest, ACallThatIsStillQueuedAtItsEndIsNeverMade) {
  spinner_.stop();
  bool called = false;
  std::optional<PeriodicCallback> callback;
  callback.emplace(nh_, kPeriod, [&called] { called = true; });
  EXPECT_TRUE(test::waitUntil([this] { return !queue_.isEmpty(); }));
  callback.reset();
  queue_.callAvailable();
  EXPECT_FALSE(called);
}

}  // namespace
}  // namespace fast_edi
