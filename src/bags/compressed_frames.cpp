#include "bags/compressed_frames.hpp"

#include <algorithm>
#include <set>
#include <string>
#include <utility>

#include <ros/message_traits.h>
#include <ros/serialization.h>
#include <sensor_msgs/Image.h>
#include <boost/make_shared.hpp>

#include "fast_edi/bags/bag_deserialise.hpp"
#include "pictures/picture.hpp"

namespace fast_edi {
namespace {

namespace traits = ros::message_traits;

/// What image_transport's `compressed` puts behind the name of the raw topic.
const std::string kSuffix = "/compressed";

bool hasCompressedFrames(const BagConnection& connection) {
  const std::string& topic = connection.topic;
  return connection.md5sum == traits::md5sum<sensor_msgs::CompressedImage>() &&
         topic.size() > kSuffix.size() &&
         topic.compare(topic.size() - kSuffix.size(), kSuffix.size(), kSuffix) == 0;
}

}  // namespace

CompressedFrames::CompressedFrames(std::unique_ptr<MessageSource> source)
    : source_(std::move(source)), connections_(source_->connections()) {
  connectDecoded();
}

void CompressedFrames::connectDecoded() {
  std::set<std::string> raw;
  std::uint32_t next_id = 1;
  for (const auto& entry : source_->connections()) {
    next_id = std::max(next_id, entry.first + 1);
    if (!hasCompressedFrames(entry.second) && entry.second.messages > 0) {
      raw.insert(entry.second.topic);
    }
  }
  for (const auto& entry : source_->connections()) {
    const BagConnection& compressed = entry.second;
    if (!hasCompressedFrames(compressed)) {
      continue;
    }
    BagConnection connection;
    connection.topic = compressed.topic.substr(0, compressed.topic.size() - kSuffix.size());
    if (raw.count(connection.topic) > 0) {
      continue;
    }
    connection.id = next_id;
    connection.datatype = traits::datatype<sensor_msgs::Image>();
    connection.md5sum = traits::md5sum<sensor_msgs::Image>();
    connection.definition = traits::definition<sensor_msgs::Image>();
    connection.messages = compressed.messages;
    connection.header = boost::make_shared<ros::M_string>();
    (*connection.header)["topic"] = connection.topic;
    (*connection.header)["type"] = connection.datatype;
    (*connection.header)["md5sum"] = connection.md5sum;
    (*connection.header)["message_definition"] = connection.definition;
    decoded_[entry.first] = next_id;
    connections_[next_id] = std::move(connection);
    ++next_id;
  }
}

bool CompressedFrames::next(BagMessage& message) {
  if (waiting_.connection != nullptr) {
    message = std::exchange(waiting_, {});
    return true;
  }
  const bool more = source_->next(message);
  noteDamageOfSource();
  if (!more) {
    return false;
  }
  message.decoded = false;
  const auto decoded = decoded_.find(message.connection->id);
  if (decoded != decoded_.end()) {
    decode(message, connections_.at(decoded->second));
  }
  return true;
}

void CompressedFrames::decode(const BagMessage& message, const BagConnection& decoded) {
  sensor_msgs::CompressedImagePtr compressed;
  try {
    compressed = deserialise<sensor_msgs::CompressedImage>(message);
  } catch (const ros::serialization::StreamOverrunException&) {
    damage_.push_back({message.offset, "a message on " + message.connection->topic +
                                           " that is shorter than it says"});
    return;
  }
  Picture picture;
  const std::string fault = decodeCompressed(
      {compressed->format, compressed->data.data(), compressed->data.size()}, picture);
  if (!fault.empty()) {
    damage_.push_back({message.offset, "a frame on " + message.connection->topic + ": " + fault});
    return;
  }
  sensor_msgs::Image image;
  image.header = compressed->header;
  image.width = static_cast<std::uint32_t>(picture.size.width);
  image.height = static_cast<std::uint32_t>(picture.size.height);
  image.encoding = picture.encoding;
  image.step = static_cast<std::uint32_t>(picture.pixels.size() / image.height);
  image.data = std::move(picture.pixels);
  bytes_.resize(ros::serialization::serializationLength(image));
  ros::serialization::OStream stream(bytes_.data(), static_cast<std::uint32_t>(bytes_.size()));
  ros::serialization::serialize(stream, image);
  waiting_ = message;
  waiting_.connection = &decoded;
  waiting_.data = bytes_.data();
  waiting_.size = static_cast<std::uint32_t>(bytes_.size());
  waiting_.decoded = true;
}

void CompressedFrames::noteDamageOfSource() {
  const std::vector<BagDamage>& damage = source_->damage();
  for (; damage_of_source_ < damage.size(); ++damage_of_source_) {
    damage_.push_back(damage[damage_of_source_]);
  }
}

}  // namespace fast_edi
