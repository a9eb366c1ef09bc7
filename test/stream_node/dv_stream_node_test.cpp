/// The node within this process, between a stand-in server and subscribers.
#include "stream_node/dv_stream_node.hpp"

#include <atomic>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include <diagnostic_msgs/DiagnosticArray.h>
#include <gmock/gmock.h>
#include <ros/ros.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/TimeReference.h>
#include <std_msgs/Int32.h>

#include "fast_edi/messages/event_array.hpp"
#include "rostest/node_client.hpp"
#include "rostest/ros_process.hpp"
#include "stream/served_stream.hpp"
#include "stream/stream_server.hpp"
#include "support/temporary_directory.hpp"

namespace fast_edi {
namespace {

using test::waitUntil;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::ServedStream;
using testing::StreamBytes;
using testing::StreamPeer;
using testing::StreamServer;

constexpr std::int64_t kStart_ns = 1'700'000'000'000'000'000;
constexpr SensorSize kSize{4, 3};
constexpr char kNode[] = "/camera/dv_stream";

/// What was published, in order of arrival, each topic for itself.
class DvStreamNodeTest : public ::testing::Test {
 protected:
  DvStreamNodeTest() {
    test::requireRos();
    ros::param::del(kNode);
    set("events_port", 0);
    set("frames_port", 0);
    nh_ = std::make_unique<ros::NodeHandle>("/camera");
    keep("events", events_);
    keep("image_raw", images_);
    keep("exposure", exposures_);
    keep("camera_info", infos_);
    keep("imu", samples_);
    keep("triggers", triggers_);
    subscribers_.push_back(nh_->subscribe<diagnostic_msgs::DiagnosticArray>(
        "/diagnostics", 100, [this](const diagnostic_msgs::DiagnosticArrayConstPtr& array) {
          for (const auto& status : array->status) {
            report_ = status;
          }
        }));
  }

  template <typename Value>
  static void set(const std::string& key, const Value& value) {
    ros::param::set(std::string(kNode) + "/" + key, value);
  }

  void serve(const std::string& stream, const ServedStream& served, int connections = 1) {
    servers_.push_back(
        std::make_unique<StreamServer>([this, served, connections](StreamPeer& peer) {
          peer.send(served.header);
          while (!go_) {
            peer.pause(std::chrono::milliseconds(1));
          }
          for (const std::string& packet : served.packets) {
            peer.send(packet);
          }
          if (peer.number() + 1 >= connections) {
            peer.waitForEnd();
          }
        }));
    set(stream + "_port", static_cast<int>(servers_.back()->endpoint().port));
  }

  void start() {
    node_ = std::make_unique<DvStreamNode>(*nh_, ros::NodeHandle(kNode), kNode);
    go_ = true;
  }

  /// Takes messages in until \p condition holds.
  template <typename Condition>
  bool spinUntil(Condition condition) {
    return waitUntil([&] {
      ros::spinOnce();
      return condition();
    });
  }

  std::vector<boost::shared_ptr<const EventArray>> events_;
  std::vector<sensor_msgs::ImageConstPtr> images_;
  std::vector<std_msgs::Int32ConstPtr> exposures_;
  std::vector<sensor_msgs::CameraInfoConstPtr> infos_;
  std::vector<sensor_msgs::ImuConstPtr> samples_;
  std::vector<sensor_msgs::TimeReferenceConstPtr> triggers_;
  diagnostic_msgs::DiagnosticStatus report_;
  std::unique_ptr<DvStreamNode> node_;

 private:
  template <typename Message>
  void keep(const char* topic, std::vector<boost::shared_ptr<const Message>>& messages) {
    subscribers_.push_back(
        nh_->subscribe<Message>(topic, 100,
                                boost::function<void(const boost::shared_ptr<const Message>&)>(
                                    [&messages](const boost::shared_ptr<const Message>& message) {
                                      messages.push_back(message);
                                    })));
  }

  std::atomic<bool> go_{false};
  std::unique_ptr<ros::NodeHandle> nh_;
  std::vector<ros::Subscriber> subscribers_;
  std::vector<std::unique_ptr<StreamServer>> servers_;
};

ServedStream eventStream() {
  StreamBytes bytes({StreamKind::kEvents, "events", "DAVIS", kSize}, Aedat4Compression::kLz4);
  bytes.add(std::vector<Event>{{1, 2, kStart_ns, true}, {3, 0, kStart_ns + 1000, false}});
  bytes.add(std::vector<Event>{{0, 0, kStart_ns + 2000, true}});
  return bytes.take();
}

ServedStream frameStream() {
  StreamBytes bytes({StreamKind::kFrames, "frames", "DAVIS", kSize}, Aedat4Compression::kNone);
  const std::vector<std::uint8_t> pixels = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
  RecordedFrame frame;
  frame.exposure = ExposureInterval{kStart_ns, kStart_ns + 10 * kNanosecondsPerMillisecond};
  frame.size = kSize;
  frame.encoding = "mono8";
  frame.pixels = pixels.data();
  frame.bytes = pixels.size();
  bytes.add(frame);
  return bytes.take();
}

ros::Time timeOf(std::int64_t t_ns) {
  ros::Time time;
  time.fromNSec(static_cast<std::uint64_t>(t_ns));
  return time;
}

TEST_F(DvStreamNodeTest, PublishesWhatTheDriverWould) {
  serve("events", eventStream());
  serve("frames", frameStream());
  StreamBytes imu({StreamKind::kImu, "imu", "DAVIS", {}}, Aedat4Compression::kNone);
  imu.add(RecordedImu{kStart_ns, {1.0, 2.0, 3.0}, {}});
  serve("imu", imu.take());
  StreamBytes triggers({StreamKind::kTriggers, "triggers", "DAVIS", {}}, Aedat4Compression::kNone);
  triggers.add(RecordedTrigger{kStart_ns + 5000, 2});
  serve("triggers", triggers.take());
  set("frame_id", "camera");
  start();
  ASSERT_EQ(node_->configurationError(), "");
  ASSERT_TRUE(spinUntil([this] {
    return events_.size() == 2 && images_.size() == 1 && exposures_.size() == 1 &&
           samples_.size() == 1 && triggers_.size() == 1;
  }));
  EXPECT_EQ(events_[0]->header.stamp, timeOf(kStart_ns));
  EXPECT_EQ(events_[0]->header.frame_id, "camera");
  EXPECT_EQ(events_[0]->width, 4U);
  EXPECT_EQ(events_[0]->height, 3U);
  ASSERT_EQ(events_[0]->events().count, 2U);
  const Event event = decodeWireEvent(events_[0]->events().record(1));
  EXPECT_EQ(event.x, 3);
  EXPECT_EQ(event.t_ns, kStart_ns + 1000);
  EXPECT_FALSE(event.on);
  EXPECT_EQ(images_[0]->header.stamp, timeOf(kStart_ns + 5 * kNanosecondsPerMillisecond));
  EXPECT_EQ(images_[0]->header.frame_id, "camera");
  EXPECT_EQ(images_[0]->encoding, "mono8");
  EXPECT_THAT(images_[0]->data, ElementsAre(1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12));
  EXPECT_EQ(exposures_[0]->data, 10'000);
  EXPECT_NEAR(samples_[0]->linear_acceleration.z, 3.0, 1e-6);
  EXPECT_EQ(triggers_[0]->header.stamp, timeOf(kStart_ns + 5000));
  EXPECT_EQ(triggers_[0]->source, "2");
  EXPECT_TRUE(infos_.empty()) << "no calibration was given";
  ASSERT_TRUE(spinUntil([this] {
    return report_.message == "receiving events, frames, IMU samples, triggers";
  })) << report_.message;
}

TEST_F(DvStreamNodeTest, ArraysAreHandedOverAsPointers) {
  serve("events", eventStream());
  start();
  ASSERT_TRUE(spinUntil([this] { return events_.size() == 2; }));
  EXPECT_EQ(events_[0]->decodingSince(), 0) << "it was serialised";
  EXPECT_EQ(events_[1]->header.seq, events_[0]->header.seq + 1);
}

TEST_F(DvStreamNodeTest, ACutIsAHoleInTheSequence) {
  serve("events", eventStream(), 2);
  start();
  ASSERT_TRUE(spinUntil([this] { return events_.size() == 4; }));
  EXPECT_EQ(events_[1]->header.seq, events_[0]->header.seq + 1);
  EXPECT_EQ(events_[2]->header.seq, events_[1]->header.seq + 2);
  EXPECT_EQ(events_[3]->header.seq, events_[2]->header.seq + 1);
  EXPECT_TRUE(spinUntil([this] {
    return report_.message.find("1 connection(s) for events of 127.0.0.1:") != std::string::npos;
  })) << report_.message;
}

void writeCalibration(const std::string& path, int width) {
  std::ofstream(path) << "image_width: " << width
                      << "\nimage_height: 3\ndistortion_model: plumb_bob\n"
                         "camera_matrix: {data: [5, 0, 2, 0, 5, 1, 0, 0, 1]}\n"
                         "distortion_coefficients: {data: [0, 0, 0, 0, 0]}\n"
                         "rectification_matrix: {data: [1, 0, 0, 0, 1, 0, 0, 0, 1]}\n"
                         "projection_matrix: {data: [5, 0, 2, 0, 0, 5, 1, 0, 0, 0, 1, 0]}\n";
}

TEST_F(DvStreamNodeTest, ACalibrationComesWithItsFrame) {
  const TemporaryDirectory directory;
  const std::string path = directory.file("calibration.yaml");
  writeCalibration(path, 4);
  set("camera_info_file", path);
  serve("frames", frameStream());
  start();
  ASSERT_TRUE(spinUntil([this] { return !images_.empty() && !infos_.empty(); }));
  EXPECT_EQ(infos_[0]->header.stamp, images_[0]->header.stamp);
  EXPECT_EQ(infos_[0]->K[0], 5.0);
}

TEST_F(DvStreamNodeTest, AnotherSizeThanTheCalibrationsIsReported) {
  const TemporaryDirectory directory;
  const std::string path = directory.file("calibration.yaml");
  writeCalibration(path, 5);
  set("camera_info_file", path);
  serve("frames", frameStream());
  start();
  EXPECT_TRUE(spinUntil([this] {
    return report_.message.find("another size than the calibration") != std::string::npos;
  })) << report_.message;
  EXPECT_EQ(images_.size(), 1U);
  EXPECT_TRUE(infos_.empty());
}

TEST_F(DvStreamNodeTest, ABadConfigurationLeavesItIdle) {
  set("events_port", 70'000);
  start();
  EXPECT_THAT(node_->configurationError(), HasSubstr("events_port: found '70000'"));
  EXPECT_TRUE(spinUntil(
      [this] { return report_.message.find("idle, configuration refused") != std::string::npos; }));
  node_.reset();
  ros::param::del(kNode);
  set("camera_info_file", "/no/such/file");
  start();
  EXPECT_THAT(node_->configurationError(), HasSubstr("/no/such/file"));
}

TEST_F(DvStreamNodeTest, EndsWhileItWaits) {
  set("address", "127.0.0.1");
  set("events_port", 1);  // nobody is there
  serve("frames", {});    // never sends its header
  start();
  const auto begin = std::chrono::steady_clock::now();
  node_.reset();
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(2));
}

}  // namespace
}  // namespace fast_edi
