// Events of a stream to a subscriber in the same process, with a stand-in for dvs_msgs: they come
// as pointers to what dvs_msgs generates, which is what EventSubscription then takes.

#include "stream_node/event_output.hpp"

#include <vector>

#include <dvs_msgs/EventArray.h>
#include <gtest/gtest.h>
#include <ros/callback_queue.h>
#include <ros/node_handle.h>

#include "node/event_subscription.hpp"
#include "rostest/node_client.hpp"
#include "rostest/ros_process.hpp"

namespace fast_edi {
namespace {

TEST(EventOutputPointers, AreTakenWithoutBeingSerialised) {
  test::requireRos();
  ros::NodeHandle nh("/stream");
  ros::CallbackQueue queue;
  ros::NodeHandle subscriber_nh(nh);
  subscriber_nh.setCallbackQueue(&queue);
  EventOutput output(nh, "camera");
  std::vector<Event> received;
  std::vector<std::uint32_t> sequences;
  EventSubscription subscription(
      subscriber_nh, "events", {100, 1000},
      [&](const WireEvents& events, SensorSize size, std::uint32_t sequence, std::int64_t) {
        EXPECT_EQ(size.width, 346);
        sequences.push_back(sequence);
        for (std::size_t i = 0; i < events.count; ++i) {
          received.push_back(decodeWireEvent(events.record(i)));
        }
      },
      [](std::size_t events) { ADD_FAILURE() << events << " events dropped"; }, [] {});
  subscription.update();
  ASSERT_TRUE(subscription.takesPointers());
  // A second publisher of the topic in this process is the same one to roscpp.
  const ros::Publisher same = nh.advertise<dvs_msgs::EventArray>("events", 1);
  ASSERT_TRUE(test::waitUntil([&] { return same.getNumSubscribers() == 1; }));
  const int before = dvs_msgs::serialisations;

  const std::vector<Event> events = {{1, 2, 1'700'000'000'123'456'000, true},
                                     {3, 4, 1'700'000'001'000'000'000, false}};
  RecordingItem item;
  item.content = RecordedEvents{events.data(), events.size()};
  output.begin({StreamKind::kEvents, "events", "DAVIS", {346, 260}});
  output.add(item);
  output.add(item);
  output.begin({StreamKind::kEvents, "events", "DAVIS", {346, 260}});
  output.add(item);
  ASSERT_TRUE(test::waitUntil([&] {
    queue.callAvailable();
    return received.size() == 6;
  }));
  EXPECT_EQ(dvs_msgs::serialisations, before);
  EXPECT_EQ(received[4].t_ns, events[0].t_ns);
  EXPECT_EQ(received[5].x, 3);
  EXPECT_FALSE(received[5].on);
  EXPECT_TRUE(received[4].on);
  EXPECT_EQ(sequences[1], sequences[0] + 1);
  EXPECT_EQ(sequences[2], sequences[1] + 2) << "a connection that was cut leaves a hole";
}

}  // namespace
}  // namespace fast_edi
