#include "node/repeated_messages.hpp"

#include <cstdint>
#include <string>
#include <vector>

#include <diagnostic_msgs/DiagnosticArray.h>
#include <gtest/gtest.h>
#include <ros/callback_queue.h>
#include <ros/param.h>
#include <ros/spinner.h>
#include <boost/smart_ptr/make_shared.hpp>

#include "fast_edi/messages/event_array.hpp"
#include "node/deblur_node.hpp"
#include "node/diagnostic_value.hpp"
#include "rostest/camera_publishers.hpp"
#include "rostest/node_client.hpp"
#include "rostest/recording.hpp"
#include "rostest/ros_process.hpp"

namespace fast_edi {
namespace {

constexpr std::int64_t kMs = kNanosecondsPerMillisecond;

std::vector<std::uint8_t> recordsAt(const std::vector<std::int64_t>& times_ns) {
  std::vector<std::uint8_t> records;
  for (const std::int64_t t_ns : times_ns) {
    encodeWireEvent({1, 2, t_ns, true}, records);
  }
  return records;
}

TEST(RepeatedPointers, KnowTheMessageBeforeWhileSomebodyHasIt) {
  RepeatedPointers pointers;
  const auto first = boost::make_shared<const int>(1);
  auto second = boost::make_shared<const int>(1);
  EXPECT_FALSE(pointers.repeats(first));
  EXPECT_TRUE(pointers.repeats(first));
  EXPECT_FALSE(pointers.repeats(second)) << "equal, but another one";
  EXPECT_FALSE(pointers.repeats(first)) << "not the one just before";
  EXPECT_FALSE(pointers.repeats(second));
  second.reset();
  EXPECT_FALSE(pointers.repeats(boost::make_shared<const int>(1))) << "maybe at the same place";
}

TEST(RepeatedFrames, KnowFramesAndExposuresThatComeTwice) {
  RepeatedFrames frames;
  const auto frame = boost::make_shared<const int>(1);
  const auto exposure = boost::make_shared<const int>(2);
  EXPECT_FALSE(frames.repeatsImage(frame));
  EXPECT_TRUE(frames.repeatsImage(frame));
  EXPECT_FALSE(frames.repeatsExposure(exposure));
  EXPECT_TRUE(frames.repeatsExposure(exposure));
}

TEST(RepeatedFrames, AnExposureThatIsPublishedAgainBehindAnotherFrameIsNone) {
  RepeatedFrames frames;
  const auto exposure = boost::make_shared<const int>(20'000);
  for (int i = 0; i < 3; ++i) {
    EXPECT_FALSE(frames.repeatsImage(boost::make_shared<const int>(i)));
    EXPECT_FALSE(frames.repeatsExposure(exposure)) << i;
    EXPECT_TRUE(frames.repeatsExposure(exposure)) << i;
  }
}

TEST(RepeatedArrays, KnowAnArrayByNumberSizeAndEnds) {
  const std::vector<std::uint8_t> records = recordsAt({kMs, 2 * kMs, 3 * kMs});
  const std::vector<std::uint8_t> copy = records;
  const std::vector<std::uint8_t> others[] = {recordsAt({kMs, 3 * kMs}),
                                              recordsAt({0, 2 * kMs, 3 * kMs}),
                                              recordsAt({kMs, 2 * kMs, 4 * kMs})};
  RepeatedArrays arrays;
  EXPECT_FALSE(arrays.repeats({records.data(), 3}, 0)) << "the first one";
  EXPECT_TRUE(arrays.repeats({copy.data(), 3}, 0));
  EXPECT_FALSE(arrays.repeats({copy.data(), 3}, 1)) << "its number is another";
  EXPECT_FALSE(arrays.repeats({copy.data(), 0}, 1)) << "empty";
  EXPECT_FALSE(arrays.repeats({copy.data(), 0}, 1)) << "empty again";
  EXPECT_TRUE(arrays.repeats({records.data(), 3}, 1)) << "empty ones come in between";
  for (const std::vector<std::uint8_t>& other : others) {
    EXPECT_FALSE(arrays.repeats({other.data(), other.size() / kWireEventBytes}, 1));
    EXPECT_FALSE(arrays.repeats({records.data(), 3}, 1));
  }
}

TEST(DeblurNode, UsesWhatComesTwiceOnce) {
  test::requireRos();
  const std::string ns = "/repeated_messages_test";
  const std::string name = ns + "/deblur";
  for (const char* threshold : {"/contrast_threshold_on", "/contrast_threshold_off"}) {
    ros::param::set(name + threshold, 0.25);
  }
  ros::CallbackQueue queue;
  ros::NodeHandle nh(ns);
  nh.setCallbackQueue(&queue);
  ros::NodeHandle private_nh(name);
  private_nh.setCallbackQueue(&queue);
  ros::AsyncSpinner spinner(1, &queue);
  spinner.start();
  const test::CameraPublishers camera(nh);
  const DeblurNode node(nh, private_nh, name);
  ASSERT_EQ(node.configurationError(), "");

  ros::CallbackQueue own_queue;
  ros::NodeHandle own_nh(ns);
  own_nh.setCallbackQueue(&own_queue);
  int outputs = 0;
  diagnostic_msgs::DiagnosticStatus report;
  const ros::Subscriber images = own_nh.subscribe<sensor_msgs::Image>(
      "deblurred/image_raw", 100, [&](const sensor_msgs::ImageConstPtr&) { ++outputs; });
  const ros::Subscriber reports = own_nh.subscribe<diagnostic_msgs::DiagnosticArray>(
      "/diagnostics", 100, [&](const diagnostic_msgs::DiagnosticArrayConstPtr& array) {
        for (const diagnostic_msgs::DiagnosticStatus& status : array->status) {
          report = status.name.find(name.substr(1)) != std::string::npos ? status : report;
        }
      });
  ASSERT_TRUE(test::waitUntil([&] { return camera.allConnected(); }));

  test::RecordingSettings settings;
  settings.frames = 4;
  std::uint64_t repeated = 0;
  for (const test::Arrival& arrival : test::makeRecording(settings)) {
    camera.publish(arrival);
    camera.publish(arrival);
    repeated += arrival.info ? 0 : 1;
  }
  EXPECT_TRUE(test::waitUntil([&] {
    own_queue.callAvailable(ros::WallDuration(0.01));
    return testing::value(report, "Messages repeated") == std::to_string(repeated) &&
           testing::value(report, "Frames out") == std::to_string(settings.frames);
  })) << testing::value(report, "Messages repeated")
      << " of " << repeated << ", frames out " << testing::value(report, "Frames out");
  EXPECT_EQ(testing::value(report, "Frames in"), std::to_string(settings.frames));
  EXPECT_EQ(testing::value(report, "Frames deblurred"), std::to_string(settings.frames));
  EXPECT_EQ(testing::value(report, "Events late"), "0");
  EXPECT_EQ(testing::value(report, "Exposures in"), std::to_string(settings.frames));
  EXPECT_EQ(outputs, settings.frames);
}

}  // namespace
}  // namespace fast_edi
