// The tag detector as node and as nodelet, see tag_detector.test.

#include <condition_variable>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include <cv_bridge/cv_bridge.h>
#include <diagnostic_msgs/DiagnosticArray.h>
#include <gtest/gtest.h>
#include <ros/init.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/image_encodings.h>
#include <visualization_msgs/MarkerArray.h>
#include <opencv2/imgproc.hpp>

#include "rostest/child_process.hpp"
#include "rostest/node_client.hpp"
#include "tags/tag_pictures.hpp"

namespace fast_edi {
namespace test {
namespace {

using diagnostic_msgs::DiagnosticStatus;
using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

constexpr std::uint32_t kQueue = 100;
const cv::Point2d kTagCentre(150.0, 120.0);
constexpr double kTagSide_px = 60.0;
constexpr double kFocalLength_px = 330.0;
constexpr double kTagSize_m = 0.2;  // see tag_detector.test

sensor_msgs::CameraInfo calibration() {
  sensor_msgs::CameraInfo info;
  info.width = 346;
  info.height = 260;
  info.K = {kFocalLength_px, 0.0, kTagCentre.x, 0.0, kFocalLength_px, kTagCentre.y, 0.0, 0.0, 1.0};
  return info;
}

sensor_msgs::ImagePtr imageOf(const cv::Mat& grey, const std::string& encoding, ros::Time stamp) {
  std_msgs::Header header;
  header.stamp = stamp;
  cv_bridge::CvImagePtr image =
      boost::make_shared<cv_bridge::CvImage>(header, sensor_msgs::image_encodings::MONO8, grey);
  if (encoding != sensor_msgs::image_encodings::TYPE_8UC1) {
    image = cv_bridge::cvtColor(image, encoding);
  }
  image->encoding = encoding;
  return image->toImageMsg();
}

/// A camera and a consumer of detections.
class Client {
 public:
  explicit Client(const std::string& ns) : ns_(ns), nh_(ns) {
    image_ = nh_.advertise<sensor_msgs::Image>("image", kQueue);
    camera_info_ = nh_.advertise<sensor_msgs::CameraInfo>("camera_info", kQueue);
    diagnostics_ = nh_.subscribe("/diagnostics", kQueue, &Client::receiveDiagnostics, this);
    spinner_.start();
  }
  ~Client() { spinner_.stop(); }
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  bool isHeard() const {
    return image_.getNumSubscribers() > 0 && camera_info_.getNumSubscribers() > 0;
  }
  bool isUnheard() const {
    return image_.getNumSubscribers() == 0 && camera_info_.getNumSubscribers() == 0;
  }

  bool subscribeDetections() {
    detections_ = nh_.subscribe("detections", kQueue, &Client::receiveDetections, this);
    return waitUntil([this] { return isHeard() && publisherSendsToUs(ns_ + "/detections"); });
  }
  bool subscribeAnnotated() {
    annotated_ = nh_.subscribe("image_annotated", kQueue, &Client::receiveAnnotated, this);
    return waitUntil([this] { return isHeard() && publisherSendsToUs(ns_ + "/image_annotated"); });
  }
  bool unsubscribe() {
    detections_.shutdown();
    annotated_.shutdown();
    return waitUntil([this] { return isUnheard(); });
  }

  void publish(const sensor_msgs::CameraInfo& info) { camera_info_.publish(info); }
  void publish(const sensor_msgs::ImagePtr& image) { image_.publish(image); }

  /// The markers that belong to an image, or null after the deadline.
  visualization_msgs::MarkerArrayConstPtr markersFor(const sensor_msgs::ImagePtr& image) {
    publish(image);
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait_for(lock, kDeadline, [&] {
      return last_markers_ && last_markers_->markers.at(0).header.stamp == image->header.stamp;
    });
    return last_markers_;
  }
  sensor_msgs::ImageConstPtr annotated(const sensor_msgs::ImagePtr& image) {
    publish(image);
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait_for(lock, kDeadline, [&] {
      return last_annotated_ && last_annotated_->header.stamp == image->header.stamp;
    });
    return last_annotated_;
  }
  bool waitForReport(const std::function<bool(const DiagnosticStatus&)>& condition) {
    std::unique_lock<std::mutex> lock(mutex_);
    return changed_.wait_for(lock, kDeadline, [&] { return condition(report_); });
  }
  DiagnosticStatus report() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return report_;
  }

 private:
  void receiveDetections(const visualization_msgs::MarkerArrayConstPtr& markers) {
    const std::lock_guard<std::mutex> lock(mutex_);
    last_markers_ = markers;
    changed_.notify_all();
  }
  void receiveAnnotated(const sensor_msgs::ImageConstPtr& image) {
    const std::lock_guard<std::mutex> lock(mutex_);
    last_annotated_ = image;
    changed_.notify_all();
  }
  void receiveDiagnostics(const diagnostic_msgs::DiagnosticArrayConstPtr& diagnostics) {
    const std::lock_guard<std::mutex> lock(mutex_);
    for (const DiagnosticStatus& status : diagnostics->status) {
      if (status.name == ns_.substr(1) + "/detector: tag detection") {
        report_ = status;
        changed_.notify_all();
      }
    }
  }

  std::string ns_;
  ros::NodeHandle nh_;
  std::mutex mutex_;
  std::condition_variable changed_;
  visualization_msgs::MarkerArrayConstPtr last_markers_;
  sensor_msgs::ImageConstPtr last_annotated_;
  DiagnosticStatus report_;
  ros::Publisher image_;
  ros::Publisher camera_info_;
  ros::Subscriber diagnostics_;
  ros::Subscriber detections_;
  ros::Subscriber annotated_;
  ros::AsyncSpinner spinner_{1};
};

class TagDetectorTest : public ::testing::Test {
 protected:
  /// An image with a stamp that no other one has.
  sensor_msgs::ImagePtr next(const cv::Mat& grey, const std::string& encoding = "mono8") {
    ++second_;
    return imageOf(grey, encoding, ros::Time(second_, 5000));
  }

  const cv::Mat with_tag_ = frameWithTag(7, squareAt(kTagCentre, kTagSide_px));
  const cv::Mat without_tag_ = cv::Mat(260, 346, CV_8UC1, cv::Scalar(90));
  std::uint32_t second_ = 100;
  Client client_{"/good"};
};

TEST_F(TagDetectorTest, ListensOnlyWhileSomebodyListensToIt) {
  EXPECT_TRUE(client_.waitForReport([](const DiagnosticStatus& status) {
    return status.message.find("idle") != std::string::npos;
  })) << client_.report().message;
  EXPECT_TRUE(client_.isUnheard());
  EXPECT_TRUE(client_.subscribeDetections());
  EXPECT_TRUE(client_.unsubscribe());
}

TEST_F(TagDetectorTest, FindsTheTagAndForgetsItWhenItIsGone) {
  ASSERT_TRUE(client_.subscribeDetections());
  const sensor_msgs::ImagePtr image = next(with_tag_);
  const auto markers = client_.markersFor(image);
  ASSERT_TRUE(markers);
  ASSERT_EQ(markers->markers.size(), 2U);
  EXPECT_EQ(markers->markers[0].action, Marker::DELETEALL);
  const Marker& tag = markers->markers[1];
  EXPECT_EQ(tag.action, Marker::ADD);
  EXPECT_EQ(tag.ns, "36h11");
  EXPECT_EQ(tag.id, 7);
  EXPECT_EQ(tag.header.stamp, image->header.stamp);
  EXPECT_EQ(tag.header.frame_id, "fallback");
  ASSERT_EQ(tag.points.size(), 4U);
  EXPECT_NEAR(tag.points[0].x, kTagCentre.x - 0.5 * kTagSide_px, 0.3);
  EXPECT_NEAR(tag.points[0].y, kTagCentre.y + 0.5 * kTagSide_px, 0.3);
  const auto gone = client_.markersFor(next(without_tag_));
  ASSERT_TRUE(gone);
  EXPECT_EQ(gone->markers.size(), 1U);
}

TEST_F(TagDetectorTest, GivesPosesOnceItKnowsTheCamera) {
  ASSERT_TRUE(client_.subscribeDetections());
  // Image and calibration come on connections of their own, in either order.
  Marker tag;
  EXPECT_TRUE(waitUntil([&] {
    client_.publish(calibration());
    const auto markers = client_.markersFor(next(with_tag_));
    tag = markers && markers->markers.size() == 2 ? markers->markers[1] : Marker();
    return tag.color.a > 0.0F;
  }));
  EXPECT_NEAR(tag.pose.position.x, 0.0, 0.01);
  EXPECT_NEAR(tag.pose.position.y, 0.0, 0.01);
  EXPECT_NEAR(tag.pose.position.z, kFocalLength_px * kTagSize_m / kTagSide_px, 0.02);
  EXPECT_NEAR(tag.scale.x, kTagSize_m, 1e-9);
}

TEST_F(TagDetectorTest, ReadsEachEncoding) {
  ASSERT_TRUE(client_.subscribeDetections());
  for (const char* encoding : {"mono8", "8UC1", "mono16", "rgb8", "bgr8"}) {
    const auto markers = client_.markersFor(next(with_tag_, encoding));
    ASSERT_TRUE(markers) << encoding;
    EXPECT_EQ(markers->markers.size(), 2U) << encoding;
  }
}

TEST_F(TagDetectorTest, RefusesWhatContradictsItselfAndGoesOn) {
  ASSERT_TRUE(client_.subscribeDetections());
  const sensor_msgs::ImagePtr cut = next(with_tag_);
  cut->data.resize(100);
  client_.publish(cut);
  const sensor_msgs::ImagePtr foreign = next(with_tag_);
  foreign->encoding = "32FC1";
  client_.publish(foreign);
  const auto markers = client_.markersFor(next(with_tag_));
  ASSERT_TRUE(markers);
  EXPECT_EQ(markers->markers.size(), 2U);
  EXPECT_TRUE(client_.waitForReport([](const DiagnosticStatus& status) {
    return status.level == DiagnosticStatus::WARN &&
           status.message.find("32FC1") != std::string::npos;
  })) << client_.report().message;
  EXPECT_EQ(valueOf(client_.report(), "Internal errors"), "0");
}

TEST_F(TagDetectorTest, DrawsWhatItFound) {
  ASSERT_TRUE(client_.subscribeAnnotated());
  const auto picture = client_.annotated(next(with_tag_));
  ASSERT_TRUE(picture);
  EXPECT_EQ(picture->encoding, "bgr8");
  const cv::Mat drawn = cv_bridge::toCvCopy(picture)->image;
  ASSERT_EQ(drawn.size(), with_tag_.size());
  const cv::Vec3b above = drawn.at<cv::Vec3b>(static_cast<int>(kTagCentre.y - 0.5 * kTagSide_px),
                                              static_cast<int>(kTagCentre.x));
  EXPECT_GT(above[1], above[0] + 50) << "no green outline";
}

TEST_F(TagDetectorTest, CountsFramesAndReportsSilence) {
  ASSERT_TRUE(client_.subscribeDetections());
  const auto count = [this](const char* key) {
    return std::atoi(valueOf(client_.report(), key).c_str());
  };
  ASSERT_TRUE(client_.waitForReport([](const DiagnosticStatus& status) {
    return status.message == "detecting tags" || status.message.find("no image") == 0;
  })) << client_.report().message;
  const int frames = count("Frames");
  const int with_tags = count("Frames with tags");
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(client_.markersFor(next(i == 1 ? without_tag_ : with_tag_)));
  }
  EXPECT_TRUE(client_.waitForReport([&](const DiagnosticStatus& status) {
    return valueOf(status, "Frames") == std::to_string(frames + 3) &&
           valueOf(status, "Frames with tags") == std::to_string(with_tags + 2) &&
           valueOf(status, "Tags in the last frame") == "1";
  })) << client_.report();
  EXPECT_TRUE(client_.waitForReport([](const DiagnosticStatus& status) {
    return status.level == DiagnosticStatus::ERROR &&
           status.message.find("no image on /good/image for") != std::string::npos;
  })) << client_.report().message;
}

TEST(TagDetectorNodelet, ABadConfigurationIsReportedAndLeavesTheManagerAlive) {
  Client bad("/bad");
  EXPECT_TRUE(bad.waitForReport([](const DiagnosticStatus& status) {
    return status.level == DiagnosticStatus::ERROR &&
           status.message.find("family: found '36h12', expected one of: 36h11") !=
               std::string::npos;
  })) << bad.report().message;
  EXPECT_TRUE(bad.isUnheard()) << "not idle";
  Client good("/good");
  EXPECT_TRUE(good.subscribeDetections());
}

TEST(TagDetectorNode, EndsWithAnErrorWhenItsConfigurationIsUnusable) {
  ChildProcess node({FAST_EDI_TOOLS_DIR "/tag_detector_node", "__name:=unusable", "_threads:=0"});
  EXPECT_EQ(node.wait(), 1);
}

}  // namespace
}  // namespace test
}  // namespace fast_edi

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "tag_detector_live");
  const ros::NodeHandle keeps_ros_running;
  return RUN_ALL_TESTS();
}
