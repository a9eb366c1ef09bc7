// Stands in for VINS-Mono's nodes: reads the same configuration, subscribes to the same topics with
// the same rules, and tells what it received. Either node, by the first argument.
//
//   feature_tracker  answers each frame on ~feature; a gap above 1 s or an older stamp makes it
//   send
//                    ~restart, as the real one does
//   vins_estimator   answers each feature message on ~odometry; see `position` below

#include <cstdint>
#include <iostream>
#include <memory>
#include <numeric>
#include <stdexcept>
#include <string>

#include <nav_msgs/Odometry.h>
#include <ros/init.h>
#include <ros/node_handle.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/PointCloud.h>
#include <std_msgs/Bool.h>
#include <opencv2/core/persistence.hpp>

namespace {

/// Subscribes to the input once somebody takes the output, so that playing, which waits for
/// subscribers, loses nothing on the way.
void waitForSubscriber(const ros::Publisher& publisher) {
  while (ros::ok() && publisher.getNumSubscribers() == 0) {
    ros::WallDuration(0.01).sleep();
  }
}

/// A topic in VINS-Mono's configuration file.
std::string topicFrom(const ros::NodeHandle& node, const std::string& key) {
  std::string file;
  if (!node.getParam("config_file", file)) {
    throw std::runtime_error("no parameter config_file");
  }
  if (!node.hasParam("vins_folder")) {
    throw std::runtime_error("no parameter vins_folder");
  }
  const cv::FileStorage settings(file, cv::FileStorage::READ);
  const std::string topic = settings[key];
  if (topic.empty()) {
    throw std::runtime_error(file + ": no " + key);
  }
  return topic;
}

class FeatureTracker {
 public:
  explicit FeatureTracker(ros::NodeHandle node)
      : feature_(node.advertise<sensor_msgs::PointCloud>("feature", 1000)),
        restart_(node.advertise<std_msgs::Bool>("restart", 1000)) {
    waitForSubscriber(feature_);
    constexpr int kQueue = 100;
    image_ = node.subscribe(topicFrom(node, "image_topic"), kQueue, &FeatureTracker::track, this);
  }

 private:
  void track(const sensor_msgs::ImageConstPtr& image) {
    const ros::Time stamp = image->header.stamp;
    if (!last_.isZero() && (stamp < last_ || stamp - last_ > ros::Duration(1.0))) {
      std_msgs::Bool restart;
      restart.data = 1;
      restart_.publish(restart);
    }
    last_ = stamp;
    if (image->encoding != "mono8") {
      throw std::runtime_error("expected mono8, got " + image->encoding);
    }
    sensor_msgs::PointCloud features;
    features.header = image->header;
    geometry_msgs::Point32 mean;
    mean.z = std::accumulate(image->data.begin(), image->data.end(), 0.0F) /
             static_cast<float>(image->data.size());
    features.points.push_back(mean);
    feature_.publish(features);
  }

  ros::Publisher feature_;
  ros::Publisher restart_;
  ros::Subscriber image_;
  ros::Time last_;
};

class Estimator {
 public:
  explicit Estimator(ros::NodeHandle node)
      : odometry_(node.advertise<nav_msgs::Odometry>("odometry", 1000)) {
    waitForSubscriber(odometry_);
    constexpr int kQueue = 2000;
    features_ = node.subscribe("/feature_tracker/feature", kQueue, &Estimator::takeFeatures, this);
    restarts_ = node.subscribe("/feature_tracker/restart", kQueue, &Estimator::takeRestart, this);
    imu_ = node.subscribe(topicFrom(node, "imu_topic"), kQueue, &Estimator::takeImu, this);
  }

 private:
  void takeImu(const sensor_msgs::ImuConstPtr&) { ++readings_; }
  void takeRestart(const std_msgs::BoolConstPtr&) { ++restarts_seen_; }
  void takeFeatures(const sensor_msgs::PointCloudConstPtr& features) {
    nav_msgs::Odometry odometry;
    odometry.header = features->header;
    odometry.pose.pose.position.x = static_cast<double>(readings_);       // so far
    odometry.pose.pose.position.y = static_cast<double>(restarts_seen_);  // so far
    odometry.pose.pose.position.z = features->points.at(0).z;             // mean DN of the frame
    odometry_.publish(odometry);
  }

  ros::Publisher odometry_;
  ros::Subscriber features_;
  ros::Subscriber restarts_;
  ros::Subscriber imu_;
  std::uint64_t readings_ = 0;
  std::uint64_t restarts_seen_ = 0;
};

}  // namespace

int main(int argc, char** argv) {
  const std::string role = argc > 1 ? argv[1] : "";
  ros::init(argc, argv, role);
  const ros::NodeHandle node("~");
  try {
    if (role == "feature_tracker") {
      const FeatureTracker tracker(node);
      ros::spin();
    } else if (role == "vins_estimator") {
      const Estimator estimator(node);
      ros::spin();
    } else {
      throw std::runtime_error("expected feature_tracker or vins_estimator, got " + role);
    }
  } catch (const std::exception& error) {
    std::cerr << "vins_stand_in: " << error.what() << "\n";
    return 1;
  }
  return 0;
}
