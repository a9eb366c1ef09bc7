#include "fast_edi/ros/bag_pipeline.hpp"

#include <cstddef>
#include <utility>

#include <ros/serialization.h>
#include <std_msgs/Int32.h>
#include <boost/make_shared.hpp>

#include "fast_edi/ros/event_array.hpp"

namespace fast_edi {
namespace {

using ros::serialization::IStream;

IStream streamOf(const BagMessage& message) {
  // IStream only reads, but wants to be able to write.
  return {const_cast<std::uint8_t*>(message.data), message.size};
}

/// Throws unless as many elements as stated follow. roscpp makes room for a stated length before it
/// looks whether the message is that long, which a damaged bag would turn into gigabytes.
void requireStatedLength(IStream& stream, std::size_t element_bytes) {
  std::uint32_t count = 0;
  stream.next(count);
  if (std::uint64_t{count} * element_bytes > stream.getLength()) {
    ros::serialization::throwStreamOverrun();
  }
}

void requireLengths(IStream stream, sensor_msgs::Image image) {
  stream.next(image.header);
  stream.next(image.height);
  stream.next(image.width);
  stream.next(image.encoding);
  stream.next(image.is_bigendian);
  stream.next(image.step);
  requireStatedLength(stream, sizeof(std::uint8_t));
}

void requireLengths(IStream stream, sensor_msgs::CameraInfo info) {
  stream.next(info.header);
  stream.next(info.height);
  stream.next(info.width);
  stream.next(info.distortion_model);
  requireStatedLength(stream, sizeof(double));
}

/// \throws ros::serialization::StreamOverrunException
template <typename Message>
boost::shared_ptr<Message> readVariable(const BagMessage& raw) {
  const boost::shared_ptr<Message> message = boost::make_shared<Message>();
  IStream stream = streamOf(raw);
  requireLengths(stream, Message());
  stream.next(*message);
  return message;
}

/// \throws ros::serialization::StreamOverrunException
template <typename Message>
Message readFixed(const BagMessage& raw) {
  Message message;
  IStream stream = streamOf(raw);
  stream.next(message);
  return message;
}

}  // namespace

BagPipeline::BagPipeline(const TopicNames& topics, const LoadedParameters& parameters)
    : topics_(topics),
      camera_info_topic_(topics.cameraInfo()),
      sink_(parameters.ros.frame_id,
            [this](const sensor_msgs::ImagePtr& image, const sensor_msgs::CameraInfoPtr& info,
                   const OutputFrame& frame) {
              // Only kept here: the pipeline's calls must not throw, and writing to a full disk
              // does.
              outputs_.push_back({image, info, frame});
            }),
      deblurrer_(parameters.deblur, sink_) {}

bool BagPipeline::add(const BagMessage& message) {
  const auto now_ns = static_cast<std::int64_t>(message.time.toNSec());
  deblurrer_.advance(now_ns);
  return use(message, now_ns);
}

void BagPipeline::finish() {
  deblurrer_.finish();
}

std::vector<BagPipeline::Output> BagPipeline::takeOutputs() {
  return std::exchange(outputs_, {});
}

BagPipeline::Use BagPipeline::useOf(const BagConnection& connection) const {
  if (connection.topic == topics_.events) {
    return Use::kEvents;
  }
  if (connection.topic == topics_.image) {
    return Use::kImage;
  }
  if (connection.topic == topics_.exposure) {
    return Use::kExposure;
  }
  return connection.topic == camera_info_topic_ ? Use::kCameraInfo : Use::kNone;
}

bool BagPipeline::use(const BagMessage& message, std::int64_t now_ns) {
  try {
    switch (useOf(*message.connection)) {
      case Use::kEvents: {
        const EventArrayView array = readFixed<EventArrayView>(message);
        deblurrer_.addEvents(array.events(), sensorSize(array), array.header.seq, now_ns);
        break;
      }
      case Use::kImage: {
        const sensor_msgs::ImageConstPtr image = readVariable<sensor_msgs::Image>(message);
        const ImageReading reading = readImage(*image);
        if (reading.verdict == ImageVerdict::kMalformed) {
          return false;
        }
        deblurrer_.addFrame(makeInputFrame(image, reading, now_ns), now_ns);
        break;
      }
      case Use::kExposure:
        deblurrer_.addExposure(readFixed<std_msgs::Int32>(message).data, now_ns);
        break;
      case Use::kCameraInfo:
        sink_.setCameraInfo(readVariable<sensor_msgs::CameraInfo>(message));
        break;
      case Use::kNone:
        break;
    }
  } catch (const ros::serialization::StreamOverrunException&) {
    return false;
  }
  return true;
}

}  // namespace fast_edi
