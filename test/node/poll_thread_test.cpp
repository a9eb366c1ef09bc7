#include "node/poll_thread.hpp"

#include <atomic>
#include <chrono>
#include <future>
#include <vector>

#include <gtest/gtest.h>

#include "node/blocked_poll_thread.hpp"
#include "rostest/ros_process.hpp"

namespace fast_edi {
namespace {

TEST(PollThread, IsWaitedForWhileItIsAtWork) {
  test::requireRos();
  test::BlockedPollThread thread;
  std::atomic<bool> ended{false};
  const std::future<void> waiting = std::async(std::launch::async, [] { waitForPollThread(); });
  EXPECT_EQ(waiting.wait_for(std::chrono::milliseconds(100)), std::future_status::timeout);
  thread.finish([&ended] { ended = true; });
  waiting.wait();
  EXPECT_TRUE(ended);
}

TEST(PollThread, IsWaitedForByManyAtATime) {
  test::requireRos();
  std::vector<std::future<void>> waiting(10);
  for (std::future<void>& one : waiting) {
    one = std::async(std::launch::async, [] { waitForPollThread(); });
  }
  for (const std::future<void>& one : waiting) {
    EXPECT_EQ(one.wait_for(std::chrono::seconds(30)), std::future_status::ready);
  }
}

}  // namespace
}  // namespace fast_edi
