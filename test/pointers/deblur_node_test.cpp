// The node in the manager of a driver that publishes generated event arrays, while the node and its
// subscribers come and go. With sanitizers: nothing is used after its end, and no two threads meet.

#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <thread>

#include <dvs_msgs/EventArray.h>
#include <gtest/gtest.h>
#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/param.h>
#include <ros/spinner.h>
#include <sensor_msgs/Image.h>
#include <boost/make_shared.hpp>

#include "fast_edi/base/types.hpp"
#include "node/deblur_node.hpp"
#include "rostest/node_client.hpp"
#include "rostest/ros_process.hpp"

namespace fast_edi {
namespace {

constexpr SensorSize kSize{64, 48};
constexpr std::int64_t kMs = kNanosecondsPerMillisecond;
const std::string kNamespace = "/manager";
const std::string kNode = "/manager/deblur";

/// Events and frames, as fast as they are taken.
class Driver {
 public:
  Driver()
      : nh_(kNamespace),
        events_(nh_.advertise<dvs_msgs::EventArray>("events", 10)),
        images_(nh_.advertise<sensor_msgs::Image>("image_raw", 10)),
        thread_([this] { run(); }) {}
  ~Driver() {
    stop_ = true;
    thread_.join();
  }

 private:
  void run() {
    for (std::int64_t t_ns = 1000 * kNanosecondsPerSecond; !stop_; t_ns += kPeriod_ns) {
      auto array = boost::make_shared<dvs_msgs::EventArray>();
      array->width = static_cast<std::uint32_t>(kSize.width);
      array->height = static_cast<std::uint32_t>(kSize.height);
      array->events.resize(kEvents);
      for (std::size_t i = 0; i < kEvents; ++i) {
        dvs_msgs::Event& event = array->events[i];
        event.x = static_cast<std::uint16_t>(i % 64);
        event.y = static_cast<std::uint16_t>(i / 64 % 48);
        event.ts.fromNSec(static_cast<std::uint64_t>(t_ns) +
                          i * static_cast<std::uint64_t>(kPeriod_ns) / kEvents);
        event.polarity = i % 3 == 0 ? 1 : 0;
      }
      auto image = boost::make_shared<sensor_msgs::Image>();
      image->header.stamp.fromNSec(static_cast<std::uint64_t>(t_ns + kPeriod_ns / 2));
      image->width = array->width;
      image->height = array->height;
      image->step = image->width;
      image->encoding = "mono8";
      image->data.assign(kSize.pixelCount(), 100);
      images_.publish(image);
      events_.publish(array);
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
  }

  static constexpr std::size_t kEvents = 100'000;
  static constexpr std::int64_t kPeriod_ns = 40 * kMs;

  ros::NodeHandle nh_;
  ros::Publisher events_;
  ros::Publisher images_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

/// The parameter: how many threads call the callbacks of the node. One is what the node asks for.
class DeblurNodeWithPointers : public ::testing::TestWithParam<std::uint32_t> {
 protected:
  static void SetUpTestSuite() {
    test::requireRos();
    ros::param::set(kNode + "/contrast_threshold_on", 0.3);
    ros::param::set(kNode + "/contrast_threshold_off", 0.3);
    ros::param::set(kNode + "/exposure_source", "parameter");
    ros::param::set(kNode + "/exposure_time_us", 10'000);
  }
};

TEST_P(DeblurNodeWithPointers, WorksWhileItAndItsSubscribersComeAndGo) {
  constexpr int kNodes = 2;
  constexpr int kVisits = 4;
  const Driver driver;
  for (int i = 0; i < kNodes; ++i) {
    ros::CallbackQueue queue;
    ros::NodeHandle nh(kNamespace);
    ros::NodeHandle private_nh(kNode);
    nh.setCallbackQueue(&queue);
    private_nh.setCallbackQueue(&queue);
    ros::AsyncSpinner spinner(GetParam(), &queue);
    spinner.start();
    const DeblurNode node(nh, private_nh, kNode);
    ASSERT_EQ(node.configurationError(), "");
    for (int visit = 0; visit < kVisits; ++visit) {
      ros::CallbackQueue outputs;
      ros::NodeHandle consumer(kNamespace);
      consumer.setCallbackQueue(&outputs);
      int images = 0;
      const ros::Subscriber subscriber = consumer.subscribe<sensor_msgs::Image>(
          "deblurred/image_raw", 100, [&images](const sensor_msgs::ImageConstPtr&) { ++images; });
      EXPECT_TRUE(test::waitUntil([&] {
        outputs.callAvailable();
        return images > 0;
      }));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(ThreadsOfTheQueue, DeblurNodeWithPointers, ::testing::Values(1, 3));

}  // namespace
}  // namespace fast_edi
