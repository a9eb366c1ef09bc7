// Subscriptions of a node. Events that come as pointers, and waiting arrays, have tests of their
// own.
#include "node/node_inputs.hpp"

#include <atomic>
#include <chrono>
#include <future>
#include <memory>
#include <utility>

#include <gmock/gmock.h>
#include <ros/callback_queue.h>
#include <ros/spinner.h>
#include <boost/smart_ptr/make_shared.hpp>

#include "rostest/camera_publishers.hpp"
#include "rostest/node_client.hpp"
#include "rostest/recording.hpp"
#include "rostest/ros_process.hpp"
#include "rostest/stub_camera.hpp"

namespace fast_edi {
namespace {

constexpr std::size_t kMaxWaiting = 1'000'000;  // events
const std::string kNamespace = "/node_inputs_test";

class NodeInputsTest : public ::testing::Test {
 protected:
  struct Counts {
    std::atomic<int> events{0};
    std::atomic<int> images{0};
    std::atomic<int> infos{0};
    std::atomic<int> exposures{0};
    std::atomic<int> ticks{0};
    std::atomic<int> biases{0};
    std::atomic<int> repeated{0};
  };

  static void SetUpTestSuite() { test::requireRos(); }
  NodeInputsTest() {
    nh_.setCallbackQueue(&queue_);
    spinner_.start();
    inputs_ = std::make_unique<NodeInputs>(nh_, ros::NodeHandle(kNamespace + "/node"), kMaxWaiting,
                                           handlers());
  }

  NodeInputs::Handlers handlers() {
    NodeInputs::Handlers handlers;
    handlers.events = [this](const WireEvents&, SensorSize, std::uint32_t, std::int64_t) {
      ++counts_.events;
    };
    handlers.lost_events = [](std::size_t) {};
    handlers.events_suspended = [] {};
    handlers.image = [this](const sensor_msgs::ImageConstPtr&) { ++counts_.images; };
    handlers.camera_info = [this](const sensor_msgs::CameraInfoConstPtr&) { ++counts_.infos; };
    handlers.exposure = [this](const std_msgs::Int32ConstPtr&) { ++counts_.exposures; };
    handlers.biases = [this](const dynamic_reconfigure::ConfigConstPtr&) { ++counts_.biases; };
    handlers.tick = [this] { ++counts_.ticks; };
    handlers.repeated = [this] { ++counts_.repeated; };
    handlers.on_change = [] {};
    return handlers;
  }

  ros::CallbackQueue queue_;
  ros::NodeHandle nh_{kNamespace};
  ros::AsyncSpinner spinner_{1, &queue_};
  Counts counts_;
  std::unique_ptr<NodeInputs> inputs_;
};

TEST_F(NodeInputsTest, NothingIsReceivedBeforeTheFirstUpdateAndAllOfItAfter) {
  test::RecordingSettings settings;
  settings.frames = 3;
  const ros::Publisher biases =
      nh_.advertise<dynamic_reconfigure::Config>("bias_updates", 1, /*latch=*/true);
  biases.publish(dynamic_reconfigure::Config());
  const test::StubCamera camera(kNamespace, settings, 1);
  EXPECT_TRUE(inputs_->needsUpdate());
  EXPECT_EQ(nh_.resolveName("events"), kNamespace + "/events");
  EXPECT_EQ(counts_.ticks, 0);
  inputs_->update();
  EXPECT_TRUE(test::waitUntil([this] {
    return counts_.events > 0 && counts_.images > 0 && counts_.infos > 0 && counts_.exposures > 0 &&
           counts_.biases > 0 && counts_.ticks > 1;
  }));
}

TEST_F(NodeInputsTest, TheDestructorWaitsForCallbacksAndEndsThem) {
  inputs_->update();
  ASSERT_TRUE(test::waitUntil([this] { return counts_.ticks > 0; }));
  inputs_.reset();
  const int ticks = counts_.ticks;
  ros::WallDuration(0.02).sleep();  // five periods of the clock
  EXPECT_EQ(counts_.ticks, ticks);
}

TEST_F(NodeInputsTest, TheDestructorWaitsForTheClocksCallAtWork) {
  std::promise<void> begun;
  std::promise<void> end;
  std::atomic<bool> ended{false};
  NodeInputs::Handlers blocking = handlers();
  blocking.tick = [&, first = true]() mutable {
    if (std::exchange(first, false)) {
      begun.set_value();
      end.get_future().wait();
      ended = true;
    }
  };
  inputs_ = std::make_unique<NodeInputs>(nh_, ros::NodeHandle(kNamespace + "/node"), kMaxWaiting,
                                         std::move(blocking));
  inputs_->update();
  begun.get_future().wait();
  const std::future<void> destruction = std::async(std::launch::async, [this] { inputs_.reset(); });
  EXPECT_EQ(destruction.wait_for(std::chrono::milliseconds(100)), std::future_status::timeout);
  end.set_value();
  destruction.wait();
  EXPECT_TRUE(ended);
}

TEST_F(NodeInputsTest, CountsFramesThatAreMissing) {
  EXPECT_EQ(inputs_->missingFramesBefore(7), 0U) << "the first one";
  EXPECT_EQ(inputs_->missingFramesBefore(8), 0U);
  EXPECT_EQ(inputs_->missingFramesBefore(12), 3U);
  EXPECT_EQ(inputs_->missingFramesBefore(0), 0U) << "a restarted driver";
}

TEST_F(NodeInputsTest, GivesMessagesThatComeTwiceOnce) {
  const test::CameraPublishers camera(nh_);
  inputs_->update();
  ASSERT_TRUE(test::waitUntil([&] { return camera.allConnected(); }));
  test::Arrival image;
  image.image = boost::make_shared<const sensor_msgs::Image>();
  test::Arrival exposure;
  exposure.exposure = boost::make_shared<const std_msgs::Int32>();
  for (const test::Arrival& arrival : {image, image, exposure, exposure}) {
    camera.publish(arrival);
  }
  EXPECT_TRUE(test::waitUntil([this] { return counts_.repeated == 2; }));
  EXPECT_EQ(counts_.images, 1);
  EXPECT_EQ(counts_.exposures, 1);
}

TEST_F(NodeInputsTest, SuspendsEventsOnceUnderOverload) {
  inputs_->update();
  DeblurCounters counts;
  int suspended = 0;
  std::int64_t now_ns = kNanosecondsPerSecond;
  for (int i = 0; i < 250; ++i) {  // one second
    now_ns += 4 * kNanosecondsPerMillisecond;
    counts.events_in += 1000;
    counts.events_overflowed += 900;
    counts.frames_in += 1;
    suspended += inputs_->guardAgainstOverload(now_ns, counts) ? 1 : 0;
  }
  EXPECT_EQ(suspended, 1);
}

}  // namespace
}  // namespace fast_edi
