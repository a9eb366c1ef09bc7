#include "node/callback_thread.hpp"

#include <atomic>
#include <chrono>
#include <future>
#include <memory>
#include <thread>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <ros/callback_queue.h>
#include <ros/callback_queue_interface.h>
#include <ros/node_handle.h>
#include <boost/make_shared.hpp>

#include "node/blocked_poll_thread.hpp"
#include "rostest/ros_process.hpp"

namespace fast_edi {
namespace {

/// Counts its calls and tells the thread of the last.
struct Calls {
  std::atomic<int> count{0};
  std::atomic<std::thread::id> thread{};
};

class Call : public ros::CallbackInterface {
 public:
  explicit Call(Calls& calls) : calls_(calls) {}
  CallResult call() override {
    calls_.thread = std::this_thread::get_id();
    ++calls_.count;
    return Success;
  }

 private:
  Calls& calls_;
};

/// Lets the test decide when it ends.
class LongCall : public ros::CallbackInterface {
 public:
  LongCall(std::promise<void>& begun, std::shared_future<void> end, std::atomic<bool>& ended)
      : begun_(begun), end_(std::move(end)), ended_(ended) {}
  CallResult call() override {
    begun_.set_value();
    end_.wait();
    ended_ = true;
    return Success;
  }

 private:
  std::promise<void>& begun_;
  std::shared_future<void> end_;
  std::atomic<bool>& ended_;
};

/// \return whether there were as many calls before patience ended
bool waitFor(const Calls& calls, int count) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(30);
  while (calls.count < count && std::chrono::steady_clock::now() < deadline) {
    std::this_thread::yield();
  }
  return calls.count == count;
}

class CallbackThreadTest : public ::testing::Test {
 protected:
  CallbackThreadTest() : queue_(thread_.queue()) {}

  CallbackThread thread_;
  ros::CallbackQueueInterface& queue_;
  Calls calls_;
};

TEST_F(CallbackThreadTest, CallsInAThreadOfItsOwnOnceStarted) {
  queue_.addCallback(boost::make_shared<Call>(calls_), 1);
  EXPECT_EQ(calls_.count, 0);
  thread_.start();
  ASSERT_TRUE(waitFor(calls_, 1));
  EXPECT_NE(calls_.thread.load(), std::this_thread::get_id());
  queue_.addCallback(boost::make_shared<Call>(calls_), 1);
  EXPECT_TRUE(waitFor(calls_, 2));
}

TEST_F(CallbackThreadTest, CallsWhatIsPostedInOrder) {
  std::vector<int> called;
  std::promise<void> done;
  for (const int i : {1, 2, 3}) {
    thread_.post([&called, i] { called.push_back(i); });
  }
  thread_.post([&done] { done.set_value(); });
  thread_.start();
  done.get_future().wait();
  thread_.stop();
  thread_.post([&called] { called.push_back(4); });
  EXPECT_THAT(called, ::testing::ElementsAre(1, 2, 3));
}

TEST_F(CallbackThreadTest, CallsAgainAndAgainUntilStopped) {
  test::requireRos();
  const ros::NodeHandle nh;
  std::atomic<int> count{0};
  std::promise<std::thread::id> second;
  thread_.repeat(nh, ros::WallDuration(0.001), [&] {
    if (++count == 2) {
      second.set_value(std::this_thread::get_id());
    }
  });
  thread_.start();
  EXPECT_NE(second.get_future().get(), std::this_thread::get_id());
  thread_.stop();
  const int before = count;
  ros::CallbackQueue after;
  ros::NodeHandle other;
  other.setCallbackQueue(&after);
  std::atomic<bool> passed{false};
  const ros::SteadyTimer clock = other.createSteadyTimer(
      ros::WallDuration(0.02), [&passed](const ros::SteadyTimerEvent&) { passed = true; });
  while (!passed) {
    after.callAvailable(ros::WallDuration(0.01));
  }
  EXPECT_EQ(count, before);
}

TEST_F(CallbackThreadTest, StoppingWaitsForTheCallbackAtWork) {
  std::promise<void> begun;
  std::promise<void> end;
  std::atomic<bool> ended{false};
  queue_.addCallback(boost::make_shared<LongCall>(begun, end.get_future().share(), ended), 1);
  thread_.start();
  begun.get_future().wait();
  std::thread stopper([&] {
    thread_.stop();
    EXPECT_TRUE(ended);
  });
  end.set_value();
  stopper.join();
}

/// A request for a service that has just ended may still be on its way to the queue.
TEST_F(CallbackThreadTest, TheQueueOutlivesWhatRoscppIsAboutToQueue) {
  test::requireRos();
  auto thread = std::make_unique<CallbackThread>();
  thread->start();
  ros::CallbackQueueInterface& queue = thread->queue();
  test::BlockedPollThread poll_thread;
  std::promise<void> queued;
  const std::future<void> destruction =
      std::async(std::launch::async, [&thread] { thread.reset(); });
  EXPECT_EQ(destruction.wait_for(std::chrono::milliseconds(100)), std::future_status::timeout);
  poll_thread.finish([&] {
    queue.addCallback(boost::make_shared<Call>(calls_), 1);
    queued.set_value();
  });
  queued.get_future().wait();
  destruction.wait();
  EXPECT_EQ(calls_.count, 0);
}

TEST_F(CallbackThreadTest, NothingIsCalledAfterStopping) {
  thread_.start();
  thread_.stop();
  queue_.addCallback(boost::make_shared<Call>(calls_), 1);
  thread_.stop();
  EXPECT_EQ(calls_.count, 0);
}

TEST_F(CallbackThreadTest, WhatIsQueuedWhenItStopsIsNeverCalled) {
  std::promise<void> begun;
  std::promise<void> end;
  std::atomic<bool> ended{false};
  queue_.addCallback(boost::make_shared<LongCall>(begun, end.get_future().share(), ended), 1);
  queue_.addCallback(boost::make_shared<Call>(calls_), 2);
  EXPECT_EQ(calls_.count, 0);
  thread_.stop();
  thread_.start();
  thread_.stop();
  EXPECT_FALSE(ended);
  EXPECT_EQ(calls_.count, 0);
}

}  // namespace
}  // namespace fast_edi
