/// \file
/// From the bytes of a recorded message to the message.
#pragma once

#include <cstddef>
#include <cstdint>

#include <ros/serialization.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/CompressedImage.h>
#include <sensor_msgs/Image.h>
#include <boost/make_shared.hpp>
#include <boost/shared_ptr.hpp>

#include "fast_edi/bags/message_source.hpp"

namespace fast_edi {
namespace bag_deserialise_detail {

/// Throws unless as many elements as stated follow. roscpp makes room for a stated length before it
/// looks whether the message is that long, which a damaged bag would turn into gigabytes.
inline void requireStatedLength(ros::serialization::IStream& stream, std::size_t element_bytes) {
  std::uint32_t count = 0;
  stream.next(count);
  if (std::uint64_t{count} * element_bytes > stream.getLength()) {
    ros::serialization::throwStreamOverrun();
  }
}

template <typename Message>
struct Lengths {
  static void require(ros::serialization::IStream) {}
};

template <>
struct Lengths<sensor_msgs::Image> {
  static void require(ros::serialization::IStream stream) {
    sensor_msgs::Image image;
    stream.next(image.header);
    stream.next(image.height);
    stream.next(image.width);
    stream.next(image.encoding);
    stream.next(image.is_bigendian);
    stream.next(image.step);
    requireStatedLength(stream, sizeof(std::uint8_t));
  }
};

template <>
struct Lengths<sensor_msgs::CompressedImage> {
  static void require(ros::serialization::IStream stream) {
    sensor_msgs::CompressedImage image;
    stream.next(image.header);
    stream.next(image.format);
    requireStatedLength(stream, sizeof(std::uint8_t));
  }
};

template <>
struct Lengths<sensor_msgs::CameraInfo> {
  static void require(ros::serialization::IStream stream) {
    sensor_msgs::CameraInfo info;
    stream.next(info.header);
    stream.next(info.height);
    stream.next(info.width);
    stream.next(info.distortion_model);
    requireStatedLength(stream, sizeof(double));
  }
};

}  // namespace bag_deserialise_detail

/// Reads \p raw, whose type must be \p Message. Images, compressed ones too, and camera_infos never
/// make room for more than the bytes that are there. \throws
/// ros::serialization::StreamOverrunException when it is shorter than it says
template <typename Message>
boost::shared_ptr<Message> deserialise(const BagMessage& raw) {
  // A stream computes with the address of its data, which a message without any does not have.
  std::uint8_t nothing = 0;
  // IStream only reads, but wants to be able to write.
  std::uint8_t* data = raw.data != nullptr ? const_cast<std::uint8_t*>(raw.data) : &nothing;
  ros::serialization::IStream stream(data, raw.size);
  bag_deserialise_detail::Lengths<Message>::require(stream);
  auto message = boost::make_shared<Message>();
  stream.next(*message);
  return message;
}

}  // namespace fast_edi
