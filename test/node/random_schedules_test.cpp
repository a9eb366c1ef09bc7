/// Random schedules as recorded messages through the ROS side of the pipeline: what goes out are
/// images with their camera_info. FAST_EDI_SCHEDULES sets how many.
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <ros/serialization.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/image_encodings.h>
#include <std_msgs/Int32.h>

#include "fast_edi/bags/bag_pipeline.hpp"
#include "fast_edi/messages/event_array.hpp"
#include "support/event_generators.hpp"
#include "support/random_schedule.hpp"
#include "support/schedule_count.hpp"

namespace fast_edi {
namespace {

namespace encodings = sensor_msgs::image_encodings;

using testing::chance;
using testing::MessageKind;
using testing::Random;
using testing::ScheduledMessage;
using testing::uniform;

constexpr std::uint64_t kSchedules = 150;
constexpr SensorSize kSize{8, 6};

std::string encodingOf(const ScheduledMessage& frame) {
  if (!frame.supported) {
    return encodings::TYPE_32FC1;
  }
  const std::map<PixelFormat, std::string> names{{PixelFormat::kMono8, encodings::MONO8},
                                                 {PixelFormat::kBayer8, encodings::BAYER_GRBG8},
                                                 {PixelFormat::kMono16, encodings::MONO16},
                                                 {PixelFormat::kColour8, encodings::RGB8},
                                                 {PixelFormat::kBayer16, encodings::BAYER_RGGB16},
                                                 {PixelFormat::kColour16, encodings::BGR16},
                                                 {PixelFormat::kColourAlpha8, encodings::RGBA8},
                                                 {PixelFormat::kColourAlpha16, encodings::BGRA16}};
  return names.at(frame.format);
}

template <typename Message>
std::vector<std::uint8_t> serialise(const Message& message) {
  std::vector<std::uint8_t> bytes(ros::serialization::serializationLength(message));
  ros::serialization::OStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::serialize(stream, message);
  return bytes;
}

std::vector<std::uint8_t> serialiseEvents(const ScheduledMessage& message) {
  EventArray array;
  array.header.seq = message.sequence;
  array.width = static_cast<std::uint32_t>(message.size.width);
  array.height = static_cast<std::uint32_t>(message.size.height);
  array.assign(testing::wireView(message.records));
  return serialise(array);
}

sensor_msgs::Image imageOf(const ScheduledMessage& message) {
  sensor_msgs::Image image;
  image.header.stamp.fromNSec(static_cast<std::uint64_t>(message.stamp_ns));
  image.encoding = encodingOf(message);
  image.width = static_cast<std::uint32_t>(message.size.width);
  image.height = static_cast<std::uint32_t>(message.size.height);
  image.step = image.width * static_cast<std::uint32_t>(bytesPerPixel(message.format));
  image.data = *message.pixels;
  return image;
}

/// Delivers messages as those of a recording and checks what comes out.
class Recording {
 public:
  Recording(Random& random, const LoadedParameters& parameters)
      : random_(random), pipeline_(topics_, parameters) {
    connections_[MessageKind::kEvents].topic = topics_.events;
    connections_[MessageKind::kFrame].topic = topics_.image;
    connections_[MessageKind::kExposure].topic = topics_.exposure;
    camera_info_.topic = topics_.cameraInfo();
  }

  void deliver(const ScheduledMessage& message) {
    const BagConnection& connection = connections_.at(message.kind);
    switch (message.kind) {
      case MessageKind::kEvents:
        add(connection, serialiseEvents(message), message.now_ns);
        break;
      case MessageKind::kFrame:
        add(connection, serialise(imageOf(message)), message.now_ns);
        break;
      case MessageKind::kExposure: {
        std_msgs::Int32 exposure;
        exposure.data = message.exposure_us;
        add(connection, serialise(exposure), message.now_ns);
        break;
      }
    }
    checkOutputs();
    if (chance(random_, 3)) {
      deliverCameraInfo(message.now_ns);
    }
  }

  void finish() {
    pipeline_.finish();
    checkOutputs();
    const DeblurCounters& counters = pipeline_.counters();
    EXPECT_EQ(outputs_, counters.frames_in - counters.frames_suppressed);
    EXPECT_EQ(outputs_, counters.frames_deblurred + counters.framesPassed());
    EXPECT_LE(steps_back_, counters.frame_time_jumps);
  }

  std::uint64_t outputs() const { return outputs_; }
  std::uint64_t calibrated() const { return calibrated_; }

 private:
  void deliverCameraInfo(std::int64_t now_ns) {
    sensor_msgs::CameraInfo info;
    info.header.stamp = ros::Time(5);  // means nothing
    info.width = static_cast<std::uint32_t>(kSize.width);
    info.height = static_cast<std::uint32_t>(kSize.height);
    info.D = {0.1, 0.2};
    info.K[0] = static_cast<double>(random_() % 1000 + 1);
    if (add(camera_info_, serialise(info), now_ns)) {
      checkOutputs();  // what time alone has closed came before it
      latest_ = info;
    }
  }

  /// \return whether the message was used; one in a hundred is cut short, and must not be
  bool add(const BagConnection& connection, std::vector<std::uint8_t> bytes, std::int64_t now_ns) {
    const bool cut = chance(random_, 1);
    if (cut) {
      bytes.resize(static_cast<std::size_t>(
          uniform(random_, 0, static_cast<std::int64_t>(bytes.size()) - 1)));
      bytes.shrink_to_fit();  // so that a sanitizer sees any byte read beyond
    }
    BagMessage message;
    message.connection = &connection;
    message.time.fromNSec(static_cast<std::uint64_t>(now_ns + 1));
    message.data = bytes.data();
    message.size = static_cast<std::uint32_t>(bytes.size());
    const bool used = pipeline_.add(message);
    EXPECT_EQ(used, !cut) << connection.topic;
    return used;
  }

  void checkOutputs() {
    for (const BagPipeline::Output& output : pipeline_.takeOutputs()) {
      const sensor_msgs::Image& image = *output.image;
      const sensor_msgs::CameraInfo& info = *output.info;
      const sensor_msgs::Image& input = *messageFrame(output.frame.input).message;
      ++outputs_;
      ASSERT_EQ(info.header.stamp, image.header.stamp);
      ASSERT_EQ(info.header.frame_id, image.header.frame_id);
      ASSERT_EQ(info.header.seq, image.header.seq);
      ASSERT_EQ(image.header.frame_id, "camera");
      ASSERT_EQ(image.width, input.width);
      ASSERT_EQ(image.height, input.height);
      ASSERT_EQ(image.encoding, input.encoding);
      ASSERT_EQ(image.data.size(), input.data.size());
      if (latest_) {
        ++calibrated_;
        ASSERT_EQ(info.K, latest_->K);
        ASSERT_EQ(info.D, latest_->D);
        ASSERT_EQ(info.width, latest_->width);
        ASSERT_EQ(info.height, latest_->height);
      } else {
        ASSERT_EQ(info.K[0], 0.0);
        ASSERT_EQ(info.width, image.width);
        ASSERT_EQ(info.height, image.height);
      }
      if (last_stamp_ && image.header.stamp <= *last_stamp_) {
        ++steps_back_;
      }
      last_stamp_ = image.header.stamp;
    }
  }

  Random& random_;
  const TopicNames topics_;
  BagPipeline pipeline_;
  std::map<MessageKind, BagConnection> connections_;
  BagConnection camera_info_;
  std::optional<sensor_msgs::CameraInfo> latest_;
  std::optional<ros::Time> last_stamp_;
  std::uint64_t outputs_ = 0;
  std::uint64_t calibrated_ = 0;
  std::uint64_t steps_back_ = 0;
};

TEST(RandomMessageSchedules, EachImageHasItsCameraInfoWhateverComes) {
  std::uint64_t outputs = 0;
  std::uint64_t calibrated = 0;
  const std::uint64_t schedules = testing::scheduleCount(kSchedules);
  for (std::uint64_t seed = 0; seed < schedules; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    LoadedParameters parameters;
    parameters.ros.frame_id = "camera";
    parameters.deblur.thresholds = {0.3, 0.25};
    parameters.deblur.exposure_time_ns = chance(random, 50) ? 10'000'000 : 0;
    parameters.deblur.reference = static_cast<ExposureInstant>(uniform(random, 0, 2));
    parameters.deblur.latent.per_exposure = chance(random, 20) ? 2 : 0;
    Recording recording(random, parameters);
    const auto format = static_cast<PixelFormat>(uniform(random, 0, 7));
    for (const ScheduledMessage& message : testing::disturbedSchedule(random, kSize, format)) {
      recording.deliver(message);
      if (HasFatalFailure()) {
        return;
      }
    }
    recording.finish();
    ASSERT_FALSE(HasFailure());
    outputs += recording.outputs();
    calibrated += recording.calibrated();
  }
  EXPECT_GT(outputs, 5 * schedules);
  EXPECT_GT(calibrated, outputs / 3);
  EXPECT_LT(calibrated, outputs);
}

}  // namespace
}  // namespace fast_edi
