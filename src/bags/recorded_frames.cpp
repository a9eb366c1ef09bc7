#include "bags/recorded_frames.hpp"

#include <memory>
#include <set>

#include <ros/message_traits.h>
#include <ros/serialization.h>

#include "fast_edi/bags/bag_deserialise.hpp"
#include "fast_edi/bags/bag_error.hpp"
#include "fast_edi/bags/message_source.hpp"
#include "fast_edi/bags/open_messages.hpp"
#include "fast_edi/messages/image_pixels.hpp"
#include "fast_edi/messages/message_conversion.hpp"

namespace fast_edi {
namespace {

bool isImage(const BagConnection& connection) {
  return connection.md5sum == ros::message_traits::md5sum<sensor_msgs::Image>();
}

RecordedFrames readFrames(MessageSource& reader, const std::string& topic) {
  RecordedFrames frames;
  BagMessage message;
  while (reader.next(message)) {
    if (message.connection->topic != topic || !isImage(*message.connection)) {
      continue;
    }
    try {
      const auto image = deserialise<sensor_msgs::Image>(message);
      if (readImage(*image).verdict == ImageVerdict::kMalformed) {
        ++frames.malformed;
        continue;
      }
      frames.by_stamp[static_cast<std::int64_t>(image->header.stamp.toNSec())] = toMono8(*image);
    } catch (const ros::serialization::StreamOverrunException&) {
      ++frames.malformed;
    }
  }
  frames.damage = reader.damage();
  return frames;
}

std::string imageTopics(const MessageSource& reader) {
  std::set<std::string> topics;
  for (const auto& entry : reader.connections()) {
    if (isImage(entry.second)) {
      topics.insert(entry.second.topic);
    }
  }
  std::string text;
  for (const std::string& topic : topics) {
    text += (text.empty() ? "" : ", ") + topic;
  }
  return text.empty() ? "none" : text;
}

}  // namespace

cv::Mat toMono8(const sensor_msgs::Image& message) {
  const ImageReading reading = readImage(message);
  if (reading.verdict != ImageVerdict::kSupported) {
    return {};
  }
  if (isBayer(reading.view.format)) {
    sensor_msgs::Image raw = message;
    raw.encoding = bytesPerSample(reading.view.format) == 2 ? "mono16" : "mono8";
    return greyPixels(raw).clone();
  }
  return greyPixels(message).clone();
}

RecordedFrames readFrames(const std::vector<std::string>& recordings, const std::string& topic) {
  return readFrames(*openMessages(recordings), topic);
}

RecordedFrames requireFrames(const std::string& recording, const std::string& topic) {
  const std::unique_ptr<MessageSource> reader = openMessages(recording);
  RecordedFrames frames = readFrames(*reader, topic);
  if (frames.by_stamp.empty()) {
    throw BagError(recording + ": no frames on " + topic +
                   "; topics with images: " + imageTopics(*reader));
  }
  return frames;
}

}  // namespace fast_edi
