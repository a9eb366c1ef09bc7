#include "rostest/driver_shape.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>

#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <boost/make_shared.hpp>

#include "support/command.hpp"
#include "support/temporary_directory.hpp"

namespace fast_edi {
namespace test {

/// Written as dv_ros_msgs/EventArray.
struct DvRosEventArray {
  const EventArray& array;
};

namespace {

constexpr std::int64_t kDvInfoPeriod_ns = 40 * kNanosecondsPerMillisecond;

std::string dvRosDefinition() {
  std::string text = event_array_detail::kDefinition;
  const std::string other = "MSG: dvs_msgs/";
  return text.replace(text.find(other), other.size(), "MSG: dv_ros_msgs/");
}

const std::string kDvRosDefinition = dvRosDefinition();

ros::Time toTime(std::int64_t t_ns) {
  ros::Time time;
  time.fromNSec(static_cast<std::uint64_t>(t_ns));
  return time;
}

/// Stamps of event arrays and camera_info as dv-ros has them.
Recording asDvRos(const Recording& recording) {
  Recording shaped;
  sensor_msgs::CameraInfoConstPtr info;
  std::int64_t next_info_ns = std::numeric_limits<std::int64_t>::max();
  for (const Arrival& arrival : recording) {
    if (arrival.info) {
      if (!info) {
        info = arrival.info;
        next_info_ns = arrival.time_ns;
      }
      continue;
    }
    for (; next_info_ns <= arrival.time_ns; next_info_ns += kDvInfoPeriod_ns) {
      auto stamped = boost::make_shared<sensor_msgs::CameraInfo>(*info);
      stamped->header.stamp = toTime(next_info_ns);
      shaped.push_back({next_info_ns, nullptr, nullptr, stamped, nullptr});
    }
    shaped.push_back(arrival);
    if (arrival.events) {
      auto array = boost::make_shared<EventArray>(*arrival.events);
      const WireEvents events = array->events();
      array->header.stamp = toTime(decodeWireEvent(events.record(events.count - 1)).t_ns);
      shaped.back().events = array;
    }
  }
  return shaped;
}

bool endsWith(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

SimulatedRecording readSimulation(const std::string& path) {
  SimulatedRecording read;
  rosbag::Bag bag(path);
  for (const rosbag::MessageInstance& message : rosbag::View(bag)) {
    const std::string& topic = message.getTopic();
    const auto time_ns = static_cast<std::int64_t>(message.getTime().toNSec());
    if (endsWith(topic, "/events")) {
      read.recording.push_back(
          {time_ns, message.instantiate<EventArray>(), nullptr, nullptr, nullptr});
    } else if (endsWith(topic, "/ground_truth/image_raw")) {
      read.truth.push_back(message.instantiate<sensor_msgs::Image>());
    } else if (endsWith(topic, "/image_raw")) {
      read.recording.push_back(
          {time_ns, nullptr, message.instantiate<sensor_msgs::Image>(), nullptr, nullptr});
    } else if (endsWith(topic, "/camera_info")) {
      read.recording.push_back(
          {time_ns, nullptr, nullptr, message.instantiate<sensor_msgs::CameraInfo>(), nullptr});
    } else if (endsWith(topic, "/exposure")) {
      read.recording.push_back(
          {time_ns, nullptr, nullptr, nullptr, message.instantiate<std_msgs::Int32>()});
    }
  }
  return read;
}

}  // namespace
}  // namespace test
}  // namespace fast_edi

namespace ros {
namespace message_traits {

template <>
struct MD5Sum<fast_edi::test::DvRosEventArray> {
  static const char* value() { return MD5Sum<fast_edi::EventArray>::value(); }
  static const char* value(const fast_edi::test::DvRosEventArray&) { return value(); }
};
template <>
struct DataType<fast_edi::test::DvRosEventArray> {
  static const char* value() { return "dv_ros_msgs/EventArray"; }
  static const char* value(const fast_edi::test::DvRosEventArray&) { return value(); }
};
template <>
struct Definition<fast_edi::test::DvRosEventArray> {
  static const char* value() { return fast_edi::test::kDvRosDefinition.c_str(); }
  static const char* value(const fast_edi::test::DvRosEventArray&) { return value(); }
};

}  // namespace message_traits

namespace serialization {

template <>
struct Serializer<fast_edi::test::DvRosEventArray> {
  template <typename Stream>
  static void write(Stream& stream, const fast_edi::test::DvRosEventArray& message) {
    Serializer<fast_edi::EventArray>::write(stream, message.array);
  }
  static std::uint32_t serializedLength(const fast_edi::test::DvRosEventArray& message) {
    return Serializer<fast_edi::EventArray>::serializedLength(message.array);
  }
};

}  // namespace serialization
}  // namespace ros

namespace fast_edi {
namespace test {

DriverShape davisRosDriver() {
  DriverShape shape;
  shape.node = "/dvs/davis_ros_driver";
  shape.topics = {"/dvs/events", "/dvs/image_raw", "/dvs/camera_info", "/dvs/exposure"};
  shape.simulation = "--stamp mid --array-us 10000";
  return shape;
}

DriverShape dvRos() {
  DriverShape shape;
  shape.node = "/dvs/capture_node";
  shape.topics = {shape.node + "/events", shape.node + "/camera/image", shape.node + "/camera_info",
                  shape.node + "/exposure"};
  shape.simulation = "--stamp start --array-us 1000 --no-exposure";
  shape.is_dv_ros = true;
  return shape;
}

SimulatedRecording simulateRecording(const std::string& tools, const DriverShape& shape,
                                     const std::string& options) {
  const TemporaryDirectory directory;
  const std::string path = directory.file("simulated.bag");
  const testing::CommandResult result = testing::runCommand(
      tools + "/simulate_davis --out " + path + " " + shape.simulation + " " + options);
  if (result.exit_code != 0) {
    throw std::runtime_error("simulate_davis failed: " + result.output);
  }
  SimulatedRecording simulated = readSimulation(path);
  if (shape.is_dv_ros) {
    simulated.recording = asDvRos(simulated.recording);
  }
  return simulated;
}

void writeBag(const Recording& recording, const DriverShape& shape, const std::string& path) {
  rosbag::Bag bag(path, rosbag::bagmode::Write);
  for (const Arrival& arrival : recording) {
    const ros::Time time = toTime(arrival.time_ns);
    if (arrival.events && shape.is_dv_ros) {
      bag.write(shape.topics.events, time, DvRosEventArray{*arrival.events});
    } else if (arrival.events) {
      bag.write(shape.topics.events, time, *arrival.events);
    } else if (arrival.image) {
      bag.write(shape.topics.image, time, *arrival.image);
    } else if (arrival.info) {
      bag.write(shape.topics.camera_info, time, *arrival.info);
    } else {
      bag.write(shape.topics.exposure, time, *arrival.exposure);
    }
  }
}

double psnrOf(const sensor_msgs::Image& image, const sensor_msgs::Image& truth) {
  if (image.data.size() != truth.data.size() || image.encoding != truth.encoding) {
    throw std::invalid_argument("psnrOf: images of different size or encoding");
  }
  constexpr double kPeakDn = 255.0;
  double sum = 0.0;
  for (std::size_t i = 0; i < truth.data.size(); ++i) {
    const double difference = static_cast<double>(image.data[i]) - truth.data[i];
    sum += difference * difference;
  }
  return 10.0 * std::log10(kPeakDn * kPeakDn * static_cast<double>(truth.data.size()) / sum);
}

std::vector<Output> readOutputs(const std::string& path, const std::string& output_namespace) {
  std::vector<Output> outputs;
  std::vector<sensor_msgs::CameraInfoConstPtr> infos;
  rosbag::Bag bag(path);
  for (const rosbag::MessageInstance& message : rosbag::View(bag)) {
    if (message.getTopic() == output_namespace + "/image_raw") {
      outputs.push_back({message.instantiate<sensor_msgs::Image>(), nullptr});
    } else if (message.getTopic() == output_namespace + "/camera_info") {
      infos.push_back(message.instantiate<sensor_msgs::CameraInfo>());
    }
  }
  if (infos.size() != outputs.size()) {
    throw std::runtime_error(path + ": " + std::to_string(outputs.size()) + " images and " +
                             std::to_string(infos.size()) + " camera_info");
  }
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    outputs[i].info = infos[i];
  }
  return outputs;
}

}  // namespace test
}  // namespace fast_edi
