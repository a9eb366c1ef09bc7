#include "fast_edi/bags/recording_messages.hpp"

#include <algorithm>
#include <cctype>
#include <set>
#include <utility>

#include <ros/message_traits.h>
#include <ros/serialization.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/Imu.h>
#include <std_msgs/Int32.h>
#include <boost/make_shared.hpp>

#include "fast_edi/events/event_wire.hpp"
#include "fast_edi/messages/event_array.hpp"
#include "messages/recorded_messages.hpp"

namespace fast_edi {
namespace {

constexpr std::uint32_t kNoConnection = 0;
constexpr char kFirstNamespace[] = "/dvs";
/// A converter's arrays never grow beyond this, however long they were asked to be.
constexpr std::size_t kMaxArrayEvents = 1'000'000;
constexpr std::size_t kSpareBuffers = 4;

/// A name that a topic can have.
std::string topicName(const std::string& name) {
  std::string topic;
  for (const char c : name) {
    const bool keep = std::isalnum(static_cast<unsigned char>(c)) != 0 ||
                      (c == '/' && !topic.empty() && topic.back() != '/');
    topic += keep ? c : '_';
  }
  while (!topic.empty() && topic.back() == '/') {
    topic.pop_back();
  }
  return topic.empty() || std::isalpha(static_cast<unsigned char>(topic.front())) == 0
             ? "camera_" + topic
             : topic;
}

/// The first event outside of \p interval, or \p end. Whole blocks are looked at without a branch
/// for each event: in a recording few of them hold the end of an array.
const Event* firstOutside(const Event* begin, const Event* end, const ExposureInterval& interval) {
  constexpr std::ptrdiff_t kBlock = 256;
  const auto is_outside = [&interval](const Event& event) {
    return event.t_ns < interval.start_ns || event.t_ns >= interval.end_ns;
  };
  for (; end - begin >= kBlock; begin += kBlock) {
    int outside = 0;
    for (const Event* event = begin; event != begin + kBlock; ++event) {
      outside |= static_cast<int>(event->t_ns < interval.start_ns) |
                 static_cast<int>(event->t_ns >= interval.end_ns);
    }
    if (outside != 0) {
      break;
    }
  }
  return std::find_if(begin, end, is_outside);
}

}  // namespace

RecordingMessages::RecordingMessages(std::unique_ptr<Recording> recording, std::int64_t array_ns)
    : recording_(std::move(recording)), array_ns_(array_ns) {
  const std::vector<RecordedStream>& streams = recording_->streams();
  const auto first = std::find_if(streams.begin(), streams.end(), [](const auto& stream) {
    return stream.kind == StreamKind::kEvents;
  });
  const std::string first_camera = first != streams.end() ? first->camera : std::string();
  std::set<std::string> taken;
  const auto topic_of = [&](const RecordedStream& stream, const char* name) {
    const std::string name_space =
        stream.camera == first_camera || stream.camera.empty() || first == streams.end()
            ? kFirstNamespace
            : "/" + topicName(stream.camera);
    std::string topic = name_space + "/" + name;
    for (int number = 2; !taken.insert(topic).second; ++number) {
      topic = name_space + "/" + topicName(stream.name) + "_" + std::to_string(number) + "/" + name;
    }
    return topic;
  };
  // A camera's own frames come before those that programs made of its events.
  std::vector<std::size_t> order(streams.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    order[i] = i;
  }
  std::stable_partition(order.begin(), order.end(),
                        [&](std::size_t i) { return streams[i].name == "frames"; });
  outputs_.resize(streams.size());
  for (const std::size_t i : order) {
    Output& output = outputs_[i];
    output.size = streams[i].size;
    switch (streams[i].kind) {
      case StreamKind::kEvents:
        output.connection = connect<EventArrayView>(topic_of(streams[i], "events"));
        break;
      case StreamKind::kFrames:
        output.connection = connect<sensor_msgs::Image>(topic_of(streams[i], "image_raw"));
        output.exposure_connection = connect<std_msgs::Int32>(topic_of(streams[i], "exposure"));
        break;
      case StreamKind::kImu:
        output.connection = connect<sensor_msgs::Imu>(topic_of(streams[i], "imu"));
        break;
      case StreamKind::kCalibration:
        output.connection = connect<sensor_msgs::CameraInfo>(topic_of(streams[i], "camera_info"));
        break;
      case StreamKind::kTriggers:
        break;
    }
  }
}

RecordingMessages::~RecordingMessages() = default;

template <typename Message>
std::uint32_t RecordingMessages::connect(const std::string& topic) {
  namespace traits = ros::message_traits;
  BagConnection connection;
  connection.id = static_cast<std::uint32_t>(connections_.size() + 1);
  connection.topic = topic;
  connection.datatype = traits::DataType<Message>::value();
  connection.md5sum = traits::MD5Sum<Message>::value();
  connection.definition = traits::Definition<Message>::value();
  connection.header = boost::make_shared<ros::M_string>();
  (*connection.header)["topic"] = topic;
  (*connection.header)["type"] = connection.datatype;
  (*connection.header)["md5sum"] = connection.md5sum;
  (*connection.header)["message_definition"] = connection.definition;
  connection.messages = 1;
  connection.counted = false;
  const std::uint32_t id = connection.id;
  connections_[id] = std::move(connection);
  return id;
}

template <typename Message>
void RecordingMessages::send(std::uint32_t connection, std::int64_t record_ns,
                             const Message& message) {
  RawBytes bytes = takeSpare();
  const std::uint32_t length = ros::serialization::serializationLength(message);
  bytes.resize(length);
  ros::serialization::OStream stream(bytes.data(), length);
  ros::serialization::serialize(stream, message);
  waiting_.push_back({connection, stampOf(record_ns), std::move(bytes)});
}

RawBytes RecordingMessages::takeSpare() {
  if (spare_.empty()) {
    return {};
  }
  RawBytes bytes = std::move(spare_.back());
  spare_.pop_back();
  return bytes;
}

bool RecordingMessages::next(BagMessage& message) {
  RecordingItem item;
  while (waiting_.empty() && !ended_) {
    if (recording_->next(item)) {
      record_ns_ = item.record_ns;
      add(item);
      continue;
    }
    ended_ = true;
    for (Output& output : outputs_) {
      sendArray(output, std::max(record_ns_, output.last_ns));
    }
  }
  if (waiting_.empty()) {
    return false;
  }
  if (spare_.size() < kSpareBuffers) {
    spare_.push_back(std::move(given_.bytes));
  }
  given_ = std::move(waiting_.front());
  waiting_.pop_front();
  message.connection = &connections_.at(given_.connection);
  message.time = given_.time;
  message.data = given_.bytes.data();
  message.size = static_cast<std::uint32_t>(given_.bytes.size());
  return true;
}

void RecordingMessages::add(const RecordingItem& item) {
  Output& output = outputs_.at(item.stream);
  if (output.connection == kNoConnection) {
    return;
  }
  if (const auto* events = std::get_if<RecordedEvents>(&item.content)) {
    addEvents(output, *events, item.record_ns);
  } else if (const auto* frame = std::get_if<RecordedFrame>(&item.content)) {
    addFrame(output, *frame, item.record_ns);
  } else if (const auto* sample = std::get_if<RecordedImu>(&item.content)) {
    addImu(output, *sample, item.record_ns);
  } else if (const auto* calibration = std::get_if<RecordedCalibration>(&item.content)) {
    addCalibration(output, *calibration, item.record_ns);
  }
}

void RecordingMessages::addEvents(Output& output, const RecordedEvents& events,
                                  std::int64_t record_ns) {
  if (events.lost_arrays > 0) {
    sendArray(output, record_ns);
    output.sequence += events.lost_arrays;  // the pipeline sees the gap
  }
  const Event* const end = events.data + events.count;
  for (const Event* begin = events.data; begin != end;) {
    if (output.array.empty()) {
      output.array = takeSpare();
      output.array.resize(fieldsLength(EventArrayView()));
      output.first_ns = begin->t_ns;
    }
    const Event* array_end = end;
    if (array_ns_ > 0) {
      // From the first of the array on; also a jump back ends it.
      array_end = firstOutside(begin, end, {output.first_ns, output.first_ns + array_ns_});
    }
    const auto count = static_cast<std::size_t>(array_end - begin);
    const std::size_t encoded = output.array.size();
    output.array.resize(encoded + count * kWireEventBytes);
    encodeWireEvents(begin, count, output.array.data() + encoded);
    if (array_end != begin) {
      output.last_ns = (array_end - 1)->t_ns;
    }
    begin = array_end;
    if (array_ns_ == 0 || array_end != end ||
        output.array.size() > kMaxArrayEvents * kWireEventBytes) {
      sendArray(output, record_ns);
    }
  }
}

void RecordingMessages::sendArray(Output& output, std::int64_t record_ns) {
  if (output.array.empty()) {
    return;
  }
  EventArrayView array;
  array.header.seq = output.sequence++;
  array.header.stamp = stampOf(output.first_ns);
  array.width = static_cast<std::uint32_t>(output.size.width);
  array.height = static_cast<std::uint32_t>(output.size.height);
  const std::uint32_t length = fieldsLength(array);
  ros::serialization::OStream stream(output.array.data(), length);
  writeFields(array, (output.array.size() - length) / kWireEventBytes, stream);
  waiting_.push_back({output.connection, stampOf(record_ns), std::move(output.array)});
  output.array.clear();
}

void RecordingMessages::addFrame(Output& output, const RecordedFrame& frame,
                                 std::int64_t record_ns) {
  sensor_msgs::Image image;
  image.header.seq = output.sequence++;
  fillImage(frame, image);
  send(output.connection, record_ns, image);
  if (frame.exposure) {
    send(output.exposure_connection, record_ns, exposureMessage(*frame.exposure));
  }
}

void RecordingMessages::addImu(Output& output, const RecordedImu& sample, std::int64_t record_ns) {
  sensor_msgs::Imu message;
  message.header.seq = output.sequence++;
  fillImu(sample, message);
  send(output.connection, record_ns, message);
}

void RecordingMessages::addCalibration(const Output& output, const RecordedCalibration& calibration,
                                       std::int64_t record_ns) {
  sensor_msgs::CameraInfo info;
  info.width = static_cast<std::uint32_t>(calibration.size.width);
  info.height = static_cast<std::uint32_t>(calibration.size.height);
  info.distortion_model = calibration.distortion_model;
  info.D = calibration.distortion;
  std::copy(calibration.camera_matrix.begin(), calibration.camera_matrix.end(), info.K.begin());
  std::copy(calibration.rectification.begin(), calibration.rectification.end(), info.R.begin());
  std::copy(calibration.projection.begin(), calibration.projection.end(), info.P.begin());
  send(output.connection, record_ns, info);
}

}  // namespace fast_edi
