// Event arrays of a publisher in the same process, with a stand-in for dvs_msgs.

#include "node/event_subscription.hpp"

#include <atomic>
#include <cstdint>
#include <functional>
#include <thread>
#include <utility>
#include <vector>

#include <dvs_msgs/EventArray.h>
#include <gtest/gtest.h>
#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>
#include <boost/make_shared.hpp>

#include "fast_edi/messages/generated_event_array.hpp"
#include "fast_edi/messages/steady_time.hpp"
#include "rostest/node_client.hpp"
#include "rostest/ros_process.hpp"

namespace fast_edi {
namespace {

constexpr std::uint32_t kQueue = 100;
constexpr WaitingArrays::Limits kLimits{kQueue, 1000};

struct Received {
  std::vector<std::uint8_t> records;
  SensorSize size;
  std::uint32_t sequence = 0;
  std::int64_t arrived_ns = 0;
};

class EventPointers : public ::testing::Test {
 protected:
  static dvs_msgs::EventArray::Ptr makeArray(std::uint16_t first_x) {
    auto array = boost::make_shared<dvs_msgs::EventArray>();
    array->width = 346;
    array->height = 260;
    for (std::uint16_t i = 0; i < 5; ++i) {
      dvs_msgs::Event event;
      event.x = static_cast<std::uint16_t>(first_x + i);
      event.y = 259;
      event.ts = ros::Time(1000 + i, 999'999'999);
      event.polarity = i % 2;
      array->events.push_back(event);
    }
    return array;
  }

  static std::vector<std::uint8_t> recordsOf(const dvs_msgs::EventArray& array) {
    std::vector<std::uint8_t> records;
    for (const dvs_msgs::Event& event : array.events) {
      encodeWireEvent(
          {event.x, event.y, static_cast<std::int64_t>(event.ts.toNSec()), event.polarity != 0},
          records);
    }
    return records;
  }

  EventSubscription::Handler handler() {
    return [this](const WireEvents& events, SensorSize size, std::uint32_t sequence,
                  std::int64_t arrived_ns) {
      received_.push_back({{events.data, events.data + events.count * kWireEventBytes},
                           size,
                           sequence,
                           arrived_ns});
    };
  }

  static WaitingArrays::LossHandler onLoss() {
    return [](std::size_t events) { ADD_FAILURE() << events << " events dropped"; };
  }

  bool waitUntil(const std::function<bool()>& condition) {
    return test::waitUntil([&] {
      ros::getGlobalCallbackQueue()->callAvailable();
      return condition();
    });
  }

  static void SetUpTestSuite() { test::requireRos(); }
  void SetUp() override {
    dvs_msgs::serialisations = 0;
    began_ns_ = steadyNow();
  }

  ros::NodeHandle nh_;
  std::int64_t began_ns_ = 0;
  std::atomic<bool> changed_{false};
  std::vector<Received> received_;
};

TEST_F(EventPointers, ComeFromThisProcessWithoutBeingSerialised) {
  const ros::Publisher publisher = nh_.advertise<dvs_msgs::EventArray>("here/events", kQueue);
  EventSubscription subscription(nh_, "here/events", kLimits, handler(), onLoss(), [] {});
  subscription.update();
  EXPECT_TRUE(subscription.takesPointers());
  ASSERT_TRUE(waitUntil([&] { return publisher.getNumSubscribers() == 1; }));
  const auto array = makeArray(7);
  publisher.publish(array);
  ASSERT_TRUE(waitUntil([this] { return !received_.empty(); }));
  EXPECT_EQ(received_[0].records, recordsOf(*array));
  EXPECT_EQ(received_[0].size, (SensorSize{346, 260}));
  EXPECT_GE(received_[0].arrived_ns, began_ns_);
  EXPECT_EQ(dvs_msgs::serialisations, 0);
}

TEST_F(EventPointers, AreTakenFromThePublisherThatStartsLater) {
  EventSubscription subscription(nh_, "later/events", kLimits, handler(), onLoss(),
                                 [this] { changed_ = true; });
  subscription.update();
  EXPECT_FALSE(subscription.takesPointers());
  const ros::Publisher publisher = nh_.advertise<dvs_msgs::EventArray>("later/events", kQueue);
  ASSERT_TRUE(waitUntil([&] { return publisher.getNumSubscribers() == 1; }));
  publisher.publish(makeArray(7));
  ASSERT_TRUE(waitUntil([&] { return changed_.load(); }));
  EXPECT_TRUE(subscription.needsUpdate());
  subscription.update();
  // The array itself, and the announcement that arrays may be missing after it.
  ASSERT_TRUE(waitUntil([this] { return received_.size() >= 2; }));
  EXPECT_EQ(dvs_msgs::serialisations, 1);
  EXPECT_EQ(received_[0].records, recordsOf(*makeArray(7)));
  EXPECT_TRUE(received_[1].records.empty());
  EXPECT_EQ(received_[1].sequence, received_[0].sequence + 2);
  for (const Received& each : received_) {
    EXPECT_GE(each.arrived_ns, began_ns_);
    EXPECT_LE(each.arrived_ns, steadyNow());
  }
  EXPECT_TRUE(subscription.takesPointers());
  ASSERT_TRUE(waitUntil([&] { return publisher.getNumSubscribers() == 1; }));
  publisher.publish(makeArray(20));
  ASSERT_TRUE(waitUntil([this] { return received_.size() >= 3; }));
  EXPECT_EQ(received_[2].records, recordsOf(*makeArray(20)));
  EXPECT_EQ(dvs_msgs::serialisations, 1) << "the second array was serialised";
}

// A queue of several threads may deliver the next array before the delivery of the last one ends.
TEST_F(EventPointers, TwoThatAreDeliveredAtOnceHaveMemoryOfTheirOwn) {
  const ros::Publisher publisher = nh_.advertise<dvs_msgs::EventArray>("at_once/events", kQueue);
  const EventSubscription::Handler take = handler();
  bool is_first = true;
  EventSubscription subscription(
      nh_, "at_once/events", kLimits,
      [&](const WireEvents& events, SensorSize size, std::uint32_t sequence,
          std::int64_t arrived_ns) {
        if (std::exchange(is_first, false)) {
          std::thread([] { ros::getGlobalCallbackQueue()->callOne(); }).join();
        }
        take(events, size, sequence, arrived_ns);
      },
      onLoss(), [] {});
  subscription.update();
  ASSERT_TRUE(waitUntil([&] { return publisher.getNumSubscribers() == 1; }));
  const auto first = makeArray(7);
  const auto second = makeArray(20);
  publisher.publish(first);
  publisher.publish(second);
  ASSERT_TRUE(test::waitUntil([this] {
    ros::getGlobalCallbackQueue()->callOne();
    return received_.size() == 2;
  }));
  EXPECT_EQ(received_[0].records, recordsOf(*second)) << "it was delivered within the other one";
  EXPECT_EQ(received_[1].records, recordsOf(*first));
}

/// The parameter: how many threads call the callbacks.
class EventPointersThreads : public ::testing::TestWithParam<std::uint32_t> {
 protected:
  static void SetUpTestSuite() { test::requireRos(); }
};

TEST_P(EventPointersThreads, ComeWholeWhileSubscriptionsComeAndGo) {
  constexpr int kSubscriptions = 20;
  constexpr std::size_t kEvents = 20'000;
  constexpr std::size_t kMaxUselessPairs = 3;
  ros::CallbackQueue queue;
  ros::NodeHandle nh;
  nh.setCallbackQueue(&queue);
  const ros::Publisher publisher = nh.advertise<dvs_msgs::EventArray>("busy/events", kQueue);
  std::atomic<bool> stop{false};
  std::thread driver([&] {
    for (std::uint16_t number = 0; !stop; ++number) {
      auto array = boost::make_shared<dvs_msgs::EventArray>();
      array->width = 346;
      array->height = 260;
      array->header.seq = number;
      array->events.resize(kEvents + number % 7u);
      for (dvs_msgs::Event& event : array->events) {
        event.x = number;
      }
      publisher.publish(array);
      std::this_thread::yield();
    }
  });
  ros::AsyncSpinner spinner(GetParam(), &queue);
  spinner.start();
  std::atomic<std::size_t> mixed{0};
  for (int i = 0; i < kSubscriptions; ++i) {
    std::atomic<std::size_t> arrays{0};
    EventSubscription subscription(
        nh, "busy/events", {kQueue, 10 * kEvents},
        [&](const WireEvents& events, SensorSize, std::uint32_t sequence, std::int64_t) {
          const auto own = static_cast<std::uint16_t>(sequence);
          for (std::size_t k = 0; k < events.count; k += 1000) {
            mixed += decodeWireEvent(events.record(k)).x == own ? 0 : 1;
          }
          ++arrays;
        },
        [](std::size_t) {}, [] {});
    subscription.update();
    EXPECT_TRUE(test::waitUntil([&] { return arrays >= kMaxUselessPairs; }));
    // It ends with a delivery at work or about to be.
  }
  stop = true;
  driver.join();
  EXPECT_EQ(mixed, 0u);
}

INSTANTIATE_TEST_SUITE_P(ThreadsOfTheQueue, EventPointersThreads, ::testing::Values(1, 3));

}  // namespace
}  // namespace fast_edi
