#include "fast_edi/ros/topic_names.hpp"

#include <set>
#include <sstream>

#include <ros/message_traits.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <std_msgs/Int32.h>

#include "fast_edi/ros/event_array.hpp"

namespace fast_edi {
namespace {

using Connections = std::map<std::uint32_t, BagConnection>;

struct ExpectedType {
  std::string md5sum;
  std::string name;
};

template <typename Message>
ExpectedType expected() {
  return {ros::message_traits::md5sum<Message>(), ros::message_traits::datatype<Message>()};
}

/// Adds to \p faults what is wrong with \p topic.
void check(const Connections& connections, const std::string& topic, const std::string& option,
           const ExpectedType& type, bool required, std::ostream& faults) {
  bool found = false;
  for (const auto& entry : connections) {
    const BagConnection& connection = entry.second;
    if (connection.topic != topic) {
      continue;
    }
    found = true;
    if (connection.md5sum != type.md5sum) {
      faults << "topic " << topic << " (" << option << ") is a " << connection.datatype
             << ", expected a " << type.name << "\n";
      return;
    }
  }
  if (!found && required) {
    faults << "topic " << topic << " (" << option << ", a " << type.name << ") is not in the bag\n";
  }
}

/// The topic with messages of \p type, if there is exactly one.
std::string onlyTopic(const Connections& connections, const ExpectedType& type) {
  std::set<std::string> topics;
  for (const auto& entry : connections) {
    if (entry.second.md5sum == type.md5sum && entry.second.messages > 0) {
      topics.insert(entry.second.topic);
    }
  }
  return topics.size() == 1 ? *topics.begin() : std::string();
}

bool has(const Connections& connections, const std::string& topic) {
  for (const auto& entry : connections) {
    if (entry.second.topic == topic && entry.second.messages > 0) {
      return true;
    }
  }
  return false;
}

}  // namespace

std::string topicNamespace(const std::string& topic) {
  const std::size_t slash = topic.rfind('/');
  return slash == std::string::npos ? std::string() : topic.substr(0, slash);
}

std::string TopicNames::cameraInfo() const {
  return camera_info.empty() ? topicNamespace(image) + "/camera_info" : camera_info;
}

std::string TopicNames::outputImage() const {
  return (output.empty() ? topicNamespace(image) + "/deblurred" : output) + "/image_raw";
}

std::string TopicNames::outputCameraInfo() const {
  return (output.empty() ? topicNamespace(image) + "/deblurred" : output) + "/camera_info";
}

std::string TopicNames::outputLatent() const {
  return (output.empty() ? topicNamespace(image) : output) + "/latent/image_raw";
}

std::string checkTopics(const TopicNames& topics, const Connections& connections) {
  std::ostringstream faults;
  check(connections, topics.events, "--events", expected<EventArray>(), true, faults);
  check(connections, topics.image, "--image", expected<sensor_msgs::Image>(), true, faults);
  check(connections, topics.exposure, "--exposure", expected<std_msgs::Int32>(), false, faults);
  check(connections, topics.cameraInfo(), "--camera-info", expected<sensor_msgs::CameraInfo>(),
        false, faults);
  for (const std::string& output :
       {topics.outputImage(), topics.outputCameraInfo(), topics.outputLatent()}) {
    if (has(connections, output)) {
      faults << "topic " << output
             << " is in the bag already: give the output another namespace (--output)\n";
    }
  }
  if (faults.str().empty()) {
    return {};
  }
  faults << "the bag has:\n";
  std::set<std::string> lines;
  for (const auto& entry : connections) {
    std::ostringstream line;
    line << "  " << entry.second.topic << "  " << entry.second.datatype << "  "
         << entry.second.messages << " messages\n";
    lines.insert(line.str());
  }
  for (const std::string& line : lines) {
    faults << line;
  }
  if (lines.empty()) {
    faults << "  nothing\n";
  }
  return faults.str();
}

TopicNames guessTopics(TopicNames topics, const Connections& connections) {
  if (!has(connections, topics.events)) {
    const std::string found = onlyTopic(connections, expected<EventArray>());
    topics.events = found.empty() ? topics.events : found;
  }
  if (!has(connections, topics.image)) {
    const std::string found = onlyTopic(connections, expected<sensor_msgs::Image>());
    topics.image = found.empty() ? topics.image : found;
  }
  if (!has(connections, topics.exposure)) {
    const std::string found = onlyTopic(connections, expected<std_msgs::Int32>());
    topics.exposure = found.empty() ? topics.exposure : found;
  }
  return topics;
}

}  // namespace fast_edi
