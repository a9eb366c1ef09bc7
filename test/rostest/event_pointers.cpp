// Event arrays of a publisher in the same process, with a stand-in for dvs_msgs. The program is
// compiled with FAST_EDI_HAVE_DVS_MSGS, see CMakeLists.txt.

#include "node/event_subscription.hpp"

#include <chrono>
#include <cstdint>
#include <functional>
#include <vector>

#include <dvs_msgs/EventArray.h>
#include <gtest/gtest.h>
#include <ros/callback_queue.h>
#include <ros/init.h>
#include <ros/node_handle.h>
#include <boost/make_shared.hpp>

#include "fast_edi/messages/generated_event_array.hpp"

namespace fast_edi {
namespace test {
namespace {

constexpr std::uint32_t kQueue = 100;
constexpr WaitingArrays::Limits kLimits{kQueue, 1000};

struct Received {
  std::vector<std::uint8_t> records;
  SensorSize size;
  std::uint32_t sequence = 0;
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
    return [this](const WireEvents& events, SensorSize size, std::uint32_t sequence, std::int64_t) {
      received_.push_back(
          {{events.data, events.data + events.count * kWireEventBytes}, size, sequence});
    };
  }

  static WaitingArrays::LossHandler onLoss() {
    return [](std::size_t events) { ADD_FAILURE() << events << " events dropped"; };
  }

  bool waitUntil(const std::function<bool()>& condition) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(30);
    while (!condition()) {
      if (std::chrono::steady_clock::now() > deadline) {
        return false;
      }
      ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.01));
    }
    return true;
  }

  void SetUp() override { dvs_msgs::serialisations = 0; }

  ros::NodeHandle nh_;
  std::vector<Received> received_;
};

TEST_F(EventPointers, ComeFromThisProcessWithoutBeingSerialised) {
  const ros::Publisher publisher = nh_.advertise<dvs_msgs::EventArray>("here/events", kQueue);
  const EventSubscription subscription(nh_, "here/events", kLimits, handler(), onLoss());
  EXPECT_TRUE(subscription.takesPointers());
  ASSERT_TRUE(waitUntil([&] { return publisher.getNumSubscribers() == 1; }));
  const auto array = makeArray(7);
  publisher.publish(array);
  ASSERT_TRUE(waitUntil([this] { return !received_.empty(); }));
  EXPECT_EQ(received_[0].records, recordsOf(*array));
  EXPECT_EQ(received_[0].size, (SensorSize{346, 260}));
  EXPECT_EQ(dvs_msgs::serialisations, 0);
}

TEST_F(EventPointers, AreTakenFromThePublisherThatStartsLater) {
  const EventSubscription subscription(nh_, "later/events", kLimits, handler(), onLoss());
  EXPECT_FALSE(subscription.takesPointers());
  const ros::Publisher publisher = nh_.advertise<dvs_msgs::EventArray>("later/events", kQueue);
  ASSERT_TRUE(waitUntil([&] { return publisher.getNumSubscribers() == 1; }));
  publisher.publish(makeArray(7));
  // The array itself, and the announcement that arrays may be missing after it.
  ASSERT_TRUE(waitUntil([this] { return received_.size() >= 2; }));
  EXPECT_EQ(dvs_msgs::serialisations, 1);
  EXPECT_EQ(received_[0].records, recordsOf(*makeArray(7)));
  EXPECT_TRUE(received_[1].records.empty());
  EXPECT_EQ(received_[1].sequence, received_[0].sequence + 2);
  EXPECT_TRUE(subscription.takesPointers());
  ASSERT_TRUE(waitUntil([&] { return publisher.getNumSubscribers() == 1; }));
  publisher.publish(makeArray(20));
  ASSERT_TRUE(waitUntil([this] { return received_.size() >= 3; }));
  EXPECT_EQ(received_[2].records, recordsOf(*makeArray(20)));
  EXPECT_EQ(dvs_msgs::serialisations, 1) << "the second array was serialised";
}

}  // namespace
}  // namespace test
}  // namespace fast_edi

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "event_pointers");
  const ros::NodeHandle keeps_ros_running;
  return RUN_ALL_TESTS();
}
