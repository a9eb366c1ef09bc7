#include "fast_edi/bags/topic_names.hpp"

#include <set>
#include <sstream>

#include <ros/message_traits.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <std_msgs/Int32.h>

#include "fast_edi/messages/event_array.hpp"

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
    faults << "topic " << topic << " (" << option << ", a " << type.name
           << ") is not in the recording; name another one by " << option << "\n";
  }
}

/// False for what simulators record as the truth, and for what this package puts out.
bool mayBeInput(const std::string& topic) {
  for (const char* part : {"ground_truth", "groundtruth", "deblurred", "latent", "comparison"}) {
    if ((topic + "/").find(std::string("/") + part + "/") != std::string::npos) {
      return false;
    }
  }
  return true;
}

/// Topics that may be inputs, with messages of \p type, whose names end in \p ending.
std::set<std::string> topicsOf(const Connections& connections, const ExpectedType& type,
                               const std::string& ending = {}) {
  std::set<std::string> topics;
  for (const auto& entry : connections) {
    const std::string& topic = entry.second.topic;
    const bool ends = topic.size() >= ending.size() &&
                      topic.compare(topic.size() - ending.size(), ending.size(), ending) == 0;
    if (entry.second.md5sum == type.md5sum && entry.second.messages > 0 && ends &&
        mayBeInput(topic)) {
      topics.insert(topic);
    }
  }
  return topics;
}

/// The only one of them, else \p otherwise.
std::string onlyTopic(const std::set<std::string>& topics, const std::string& otherwise) {
  return topics.size() == 1 ? *topics.begin() : otherwise;
}

/// Many other things are integers.
constexpr const char* kExposureEnding = "exposure";

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
             << " is in the recording already: give the output another namespace (--output)\n";
    }
  }
  if (faults.str().empty()) {
    return {};
  }
  faults << "the recording has:\n";
  std::set<std::string> lines;
  for (const auto& entry : connections) {
    std::ostringstream line;
    line << "  " << entry.second.topic << "  " << entry.second.datatype;
    if (entry.second.counted) {
      line << "  " << entry.second.messages << " messages";
    }
    line << "\n";
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
  const TopicNames defaults;
  const auto may_be_another = [&](const std::string& topic, const std::string& default_name) {
    return topic == default_name && !has(connections, topic);
  };
  if (may_be_another(topics.events, defaults.events)) {
    topics.events = onlyTopic(topicsOf(connections, expected<EventArray>()), topics.events);
  }
  if (may_be_another(topics.image, defaults.image)) {
    topics.image = onlyTopic(topicsOf(connections, expected<sensor_msgs::Image>()), topics.image);
  }
  if (may_be_another(topics.exposure, defaults.exposure)) {
    topics.exposure = onlyTopic(topicsOf(connections, expected<std_msgs::Int32>(), kExposureEnding),
                                topics.exposure);
  }
  return topics;
}

std::string guessText(const TopicNames& wanted, const TopicNames& guessed,
                      const Connections& connections) {
  std::string text;
  const auto tell = [&text](const std::string& before, const std::string& after,
                            const std::string& what) {
    if (before != after) {
      text += "no messages on " + before + ": " + after + " is taken as the " + what + "\n";
    }
  };
  tell(wanted.events, guessed.events, "events, the only topic of their type");
  tell(wanted.image, guessed.image, "frames, the only topic of their type");
  tell(wanted.exposure, guessed.exposure,
       "exposure times, the only std_msgs/Int32 whose name says so");
  if (!has(connections, guessed.exposure)) {
    for (const std::string& topic : topicsOf(connections, expected<std_msgs::Int32>())) {
      text += topic +
              " is a std_msgs/Int32 and not taken as exposure times; if it is, name it by "
              "--exposure\n";
    }
  }
  return text;
}

}  // namespace fast_edi
