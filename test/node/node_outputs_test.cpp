// Publishers of a node and who subscribes to them. What is published is tested with the node.
#include "node/node_outputs.hpp"

#include <atomic>

#include <gmock/gmock.h>
#include <ros/callback_queue.h>
#include <ros/spinner.h>

#include "fast_edi/messages/event_array.hpp"
#include "rostest/node_client.hpp"
#include "rostest/ros_process.hpp"

namespace fast_edi {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

const LatentSampling kNoVideo;
const LatentSampling kVideo{4, 0};

class NodeOutputsTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { test::requireRos(); }
  NodeOutputsTest() {
    nh_.setCallbackQueue(&queue_);
    spinner_.start();
    outputs_.advertise(nh_, kVideo, [this] { ++changes_; });
  }
  ~NodeOutputsTest() override { outputs_.shutdown(); }

  ros::Subscriber subscribe(const std::string& topic) {
    return nh_.subscribe<sensor_msgs::Image>(
        topic, 10, [this](const sensor_msgs::ImageConstPtr&) { ++images_; });
  }

  ros::CallbackQueue queue_;
  ros::NodeHandle nh_{"/node_outputs_test"};
  ros::AsyncSpinner spinner_{1, &queue_};
  std::atomic<int> changes_{0};
  std::atomic<int> images_{0};
  NodeOutputs outputs_;
};

TEST_F(NodeOutputsTest, AreWantedFromTheFirstSubscriberToTheLast) {
  EXPECT_FALSE(outputs_.areWanted(kVideo));
  {
    const ros::Subscriber subscriber = subscribe("deblurred/image_raw");
    EXPECT_TRUE(test::waitUntil([this] { return outputs_.areWanted(kNoVideo); }));
    EXPECT_FALSE(outputs_.isComparisonWanted());
    EXPECT_FALSE(outputs_.isLatentWanted());
    EXPECT_TRUE(test::waitUntil([this] { return changes_ > 0; }));
  }
  EXPECT_TRUE(test::waitUntil([this] { return !outputs_.areWanted(kVideo); }));
  EXPECT_TRUE(test::waitUntil([this] { return changes_ > 1; }));
}

TEST_F(NodeOutputsTest, TheVideoIsWantedOnlyIfItIsProduced) {
  const ros::Subscriber subscriber = subscribe("latent/image_raw");
  ASSERT_TRUE(test::waitUntil([this] { return outputs_.isLatentWanted(); }));
  EXPECT_TRUE(outputs_.areWanted(kVideo));
  EXPECT_FALSE(outputs_.areWanted(kNoVideo));
}

TEST_F(NodeOutputsTest, SaysWhatTheQueueOfTheVideoCannotHold) {
  EXPECT_THAT(outputs_.latentQueueFault({100, 0}), IsEmpty());
  EXPECT_THAT(outputs_.latentQueueFault({101, 0}),
              HasSubstr("/node_outputs_test/latent/image_raw holds 400 images, expected 404"));
}

TEST_F(NodeOutputsTest, AComparisonShowsOnlyEventsSinceItHasASubscriber) {
  sensor_msgs::Image image;
  image.encoding = "mono8";
  image.width = 4;
  image.height = 4;
  image.step = 4;
  image.data.assign(16, 50);
  EventArray array;
  array.append({0, 0, 1000, true});
  const ExposureInterval window{1000, 2000};
  std::atomic<int> white{-1};  // pixels without an event in the middle third

  outputs_.addComparedEvents(array.events(), {4, 4}, {});
  const ros::Subscriber subscriber = nh_.subscribe<sensor_msgs::Image>(
      "comparison", 10, [&white](const sensor_msgs::ImageConstPtr& picture) {
        int count = 0;
        for (std::size_t y = 0; y < 4; ++y) {
          for (std::size_t x = 4; x < 8; ++x) {
            const std::uint8_t* pixel = picture->data.data() + y * picture->step + 3 * x;
            count += pixel[0] == 255 && pixel[1] == 255 && pixel[2] == 255 ? 1 : 0;
          }
        }
        white = count;
      });
  ASSERT_TRUE(test::waitUntil([this] { return outputs_.isComparisonWanted(); }));
  EXPECT_THAT(outputs_.publishComparison(image, image, window), IsEmpty());
  EXPECT_TRUE(test::waitUntil([&white] { return white == 16; })) << white;
  outputs_.addComparedEvents(array.events(), {4, 4}, {});
  EXPECT_THAT(outputs_.publishComparison(image, image, window), IsEmpty());
  EXPECT_TRUE(test::waitUntil([&white] { return white == 15; })) << white;
}

TEST_F(NodeOutputsTest, SaysWhyThereIsNoComparison) {
  sensor_msgs::Image image;
  image.encoding = "no encoding";
  EXPECT_THAT(outputs_.publishComparison(image, image, {1000, 2000}), Not(IsEmpty()));
}

}  // namespace
}  // namespace fast_edi
