#include "recording/rosbag2_topics.hpp"

#include <algorithm>
#include <array>
#include <set>
#include <string_view>
#include <utility>

namespace fast_edi {
namespace {

constexpr std::array<std::pair<std::string_view, Rosbag2Kind>, 10> kTypes = {{
    {"dvs_msgs/msg/EventArray", Rosbag2Kind::kEventArray},
    {"dv_ros2_msgs/msg/EventArray", Rosbag2Kind::kEventArray},
    {"dv_ros_msgs/msg/EventArray", Rosbag2Kind::kEventArray},
    {"prophesee_event_msgs/msg/EventArray", Rosbag2Kind::kEventArray},
    {"event_camera_msgs/msg/EventPacket", Rosbag2Kind::kEventPacket},
    {"sensor_msgs/msg/Image", Rosbag2Kind::kImage},
    {"sensor_msgs/msg/CompressedImage", Rosbag2Kind::kCompressedImage},
    {"sensor_msgs/msg/Imu", Rosbag2Kind::kImu},
    {"sensor_msgs/msg/CameraInfo", Rosbag2Kind::kCalibration},
    {"std_msgs/msg/Int32", Rosbag2Kind::kExposure},
}};
constexpr char kExposureName[] = "exposure";
constexpr char kFramesName[] = "image_raw";
/// What image_transport puts behind the name of the raw topic.
constexpr std::string_view kCompressedSuffix = "/compressed";

StreamKind streamKind(Rosbag2Kind kind) {
  switch (kind) {
    case Rosbag2Kind::kImage:
    case Rosbag2Kind::kCompressedImage:
    case Rosbag2Kind::kExposure:
      return StreamKind::kFrames;
    case Rosbag2Kind::kImu:
      return StreamKind::kImu;
    case Rosbag2Kind::kCalibration:
      return StreamKind::kCalibration;
    case Rosbag2Kind::kEventArray:
    case Rosbag2Kind::kEventPacket:
      break;
  }
  return StreamKind::kEvents;
}

/// The part behind the last slash.
std::string baseName(const std::string& topic) {
  return topic.substr(topic.rfind('/') + 1);
}

/// That of the raw frames which were compressed; empty for a topic that has none such.
std::string rawTopic(const std::string& compressed) {
  const std::size_t suffix = kCompressedSuffix.size();
  return compressed.size() > suffix &&
                 compressed.compare(compressed.size() - suffix, suffix, kCompressedSuffix) == 0
             ? compressed.substr(0, compressed.size() - suffix)
             : std::string();
}

/// What stands before it, without slashes at its ends.
std::string nameSpace(const std::string& topic) {
  const std::size_t slash = topic.rfind('/');
  if (slash == std::string::npos) {
    return {};
  }
  const std::size_t begin = std::min(topic.find_first_not_of('/'), slash);
  return topic.substr(begin, slash - begin);
}

/// The only camera with streams of a kind; nothing when there are none or several.
std::optional<std::string> onlyCamera(const std::vector<RecordedStream>& streams, StreamKind kind) {
  std::set<std::string> cameras;
  for (const RecordedStream& stream : streams) {
    if (stream.kind == kind) {
      cameras.insert(stream.camera);
    }
  }
  return cameras.size() == 1 ? std::optional(*cameras.begin()) : std::nullopt;
}

}  // namespace

std::optional<Rosbag2Kind> kindOf(const std::string& type) {
  const auto* found = std::find_if(kTypes.begin(), kTypes.end(),
                                   [&](const auto& known) { return known.first == type; });
  return found == kTypes.end() ? std::nullopt : std::optional(found->second);
}

std::optional<std::size_t> Rosbag2Streams::find(const Rosbag2Topic& topic) const {
  const std::optional<Rosbag2Kind> kind = kindOf(topic.type);
  const auto found = std::find_if(sources.begin(), sources.end(), [&](const Rosbag2Source& source) {
    return kind == source.kind && source.topic == topic.name;
  });
  return found == sources.end() ? std::nullopt
                                : std::optional(static_cast<std::size_t>(found - sources.begin()));
}

Rosbag2Streams streamsOf(const std::vector<Rosbag2Topic>& topics) {
  Rosbag2Streams result;
  const auto is_recorded_raw = [&topics](const std::string& name) {
    return std::any_of(topics.begin(), topics.end(), [&](const Rosbag2Topic& topic) {
      return topic.name == name && kindOf(topic.type) == Rosbag2Kind::kImage;
    });
  };
  for (const Rosbag2Topic& topic : topics) {
    const std::optional<Rosbag2Kind> kind = kindOf(topic.type);
    if (!kind || *kind == Rosbag2Kind::kExposure || result.find(topic)) {
      continue;
    }
    const bool compressed = *kind == Rosbag2Kind::kCompressedImage;
    const std::string name = compressed ? rawTopic(topic.name) : topic.name;
    if (compressed && (name.empty() || is_recorded_raw(name))) {
      continue;
    }
    RecordedStream stream;
    stream.kind = streamKind(*kind);
    stream.camera = nameSpace(name);
    stream.name = stream.kind == StreamKind::kFrames && baseName(name) == kFramesName
                      ? "frames"
                      : baseName(name);
    result.sources.push_back({*kind, topic.name, result.streams.size()});
    result.streams.push_back(std::move(stream));
  }
  for (const Rosbag2Topic& topic : topics) {
    if (kindOf(topic.type) != Rosbag2Kind::kExposure || baseName(topic.name) != kExposureName) {
      continue;
    }
    // Of several topics with frames in its namespace: the raw one, which comes first by its name.
    std::optional<std::size_t> frames;
    for (std::size_t i = 0; i < result.streams.size(); ++i) {
      const RecordedStream& stream = result.streams[i];
      if (stream.kind == StreamKind::kFrames && stream.camera == nameSpace(topic.name) &&
          (!frames || stream.name == "frames")) {
        frames = i;
      }
    }
    if (frames) {
      result.sources.push_back({Rosbag2Kind::kExposure, topic.name, *frames});
    }
  }
  const std::optional<std::string> events = onlyCamera(result.streams, StreamKind::kEvents);
  const std::optional<std::string> frames = onlyCamera(result.streams, StreamKind::kFrames);
  if (events && frames) {
    for (RecordedStream& stream : result.streams) {
      if (stream.camera == *frames) {
        stream.camera = *events;
      }
    }
  }
  return result;
}

}  // namespace fast_edi
