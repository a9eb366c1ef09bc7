// The ROS master ends while more events come than can be kept. Who has all connections must work
// on: frames come out, of every node of the process, and each can be unloaded.

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <future>
#include <memory>
#include <string>

#include <diagnostic_msgs/DiagnosticArray.h>
#include <gtest/gtest.h>
#include <ros/callback_queue.h>
#include <ros/init.h>
#include <ros/master.h>
#include <ros/node_handle.h>
#include <ros/param.h>
#include <ros/spinner.h>
#include <sensor_msgs/Image.h>

#include "node/deblur_node.hpp"
#include "rostest/child_process.hpp"
#include "rostest/node_client.hpp"
#include "rostest/ros_master.hpp"

namespace fast_edi {
namespace {

constexpr std::chrono::seconds kLongestUnloading(20);
/// Four seconds: longer than events are not received for.
constexpr int kFramesWithoutMaster = 100;

/// A camera, its node as a nodelet manager runs it, and who listens to it. Each has topics of its
/// own: where another node of the process has the same subscription, a new one needs no master.
class Instance {
 public:
  explicit Instance(const std::string& camera)
      : driver_({FAST_EDI_STUB_DRIVER, "__ns:=" + camera}),
        nh_(camera),
        private_nh_(camera + "/deblur"),
        spinner_(1, &queue_),
        consumer_spinner_(1, &consumer_queue_) {
    nh_.setCallbackQueue(&queue_);
    private_nh_.setCallbackQueue(&queue_);
    spinner_.start();
    node_ = std::make_unique<DeblurNode>(nh_, private_nh_, private_nh_.getNamespace());
    ros::NodeHandle consumer(camera);
    consumer.setCallbackQueue(&consumer_queue_);
    subscriber_ = consumer.subscribe<sensor_msgs::Image>(
        "deblurred/image_raw", 100, [this](const sensor_msgs::ImageConstPtr&) { ++images_; });
    consumer_spinner_.start();
  }

  int images() const { return images_; }
  bool waitForMore(int images) const {
    return test::waitUntil([this, wanted = images_ + images] { return images_ >= wanted; });
  }
  void unload() { node_.reset(); }

 private:
  test::ChildProcess driver_;
  ros::NodeHandle nh_;
  ros::NodeHandle private_nh_;
  ros::CallbackQueue queue_;
  ros::CallbackQueue consumer_queue_;
  ros::AsyncSpinner spinner_;
  ros::AsyncSpinner consumer_spinner_;
  std::atomic<int> images_{0};
  ros::Subscriber subscriber_;
  std::unique_ptr<DeblurNode> node_;
};

void configure(const std::string& camera, int max_buffered_events) {
  const std::string node = camera + "/deblur";
  ros::param::set(node + "/contrast_threshold_on", 0.3);
  ros::param::set(node + "/contrast_threshold_off", 0.3);
  ros::param::set(node + "/max_buffered_events", max_buffered_events);
}

TEST(MasterLoss, UnderOverloadFramesComeOutAndEveryNodeCanBeUnloaded) {
  auto master = std::make_unique<test::RosMaster>();
  ros::init(ros::M_string(), "master_loss",
            ros::init_options::NoSigintHandler | ros::init_options::NoRosout);
  ASSERT_TRUE(test::waitUntil([] { return ros::master::check(); }));
  ros::start();
  configure("/overloaded", 1);
  configure("/other", 1'000'000);
  Instance overloaded("/overloaded");
  Instance other("/other");
  std::atomic<int> suspensions{0};
  ros::CallbackQueue reports;
  ros::NodeHandle nh;
  nh.setCallbackQueue(&reports);
  const ros::Subscriber diagnostics = nh.subscribe<diagnostic_msgs::DiagnosticArray>(
      "/diagnostics", 10, [&suspensions](const diagnostic_msgs::DiagnosticArrayConstPtr& array) {
        for (const diagnostic_msgs::DiagnosticStatus& status : array->status) {
          suspensions = std::max(suspensions.load(),
                                 std::atoi(test::valueOf(status, "Event suspensions").c_str()));
        }
      });
  ros::AsyncSpinner spinner(1, &reports);
  spinner.start();
  ASSERT_TRUE(overloaded.waitForMore(3));
  ASSERT_TRUE(other.waitForMore(3));
  ASSERT_TRUE(test::waitUntil([&] { return suspensions > 0; }));

  master.reset();
  EXPECT_TRUE(overloaded.waitForMore(kFramesWithoutMaster));
  EXPECT_TRUE(other.waitForMore(kFramesWithoutMaster));
  auto unloading = std::async(std::launch::async, [&] {
    overloaded.unload();
    other.unload();
  });
  if (unloading.wait_for(kLongestUnloading) != std::future_status::ready) {
    std::fprintf(stderr, "unloading does not return\n");
    std::_Exit(EXIT_FAILURE);  // nothing would end any more
  }
}

}  // namespace
}  // namespace fast_edi
