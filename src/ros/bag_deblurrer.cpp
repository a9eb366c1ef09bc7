#include "fast_edi/ros/bag_deblurrer.hpp"

#include <chrono>
#include <cstddef>
#include <iomanip>
#include <ostream>
#include <string>
#include <utility>

#include <ros/serialization.h>
#include <std_msgs/Header.h>
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

void printCount(std::ostream& out, std::uint64_t count, const std::string& what) {
  if (count > 0) {
    out << "  " << std::setw(10) << count << "  " << what << "\n";
  }
}

}  // namespace

double BagDeblurReport::eventsPerMicrosecond() const {
  constexpr double kMicrosecondsPerSecond = 1e6;
  return seconds > 0.0 ? static_cast<double>(counters.events_in) / seconds / kMicrosecondsPerSecond
                       : 0.0;
}

void printSummary(std::ostream& out, const BagDeblurReport& report) {
  const DeblurCounters& counters = report.counters;
  out << "frames\n";
  out << "  " << std::setw(10) << counters.frames_in << "  in\n";
  out << "  " << std::setw(10) << report.outputs << "  out\n";
  out << "  " << std::setw(10) << counters.frames_deblurred << "  deblurred\n";
  printCount(out, counters.frames_still, "of these without any event (a still scene)");
  out << "  " << std::setw(10) << counters.framesPassed() << "  passed through unchanged\n";
  for (std::size_t reason = 0; reason < kPassReasonCount; ++reason) {
    printCount(out, counters.frames_passed[reason],
               std::string("of these: ") + toString(static_cast<PassReason>(reason)));
  }
  printCount(out, counters.frames_suppressed,
             "without output: stamp not later than the one before");
  printCount(out, counters.frames_timed_out, "closed by the timeout");
  printCount(out, counters.frame_time_jumps, "jumps of the frames' time");
  out << "events\n";
  out << "  " << std::setw(10) << counters.events_in << "  in " << counters.event_arrays
      << " arrays\n";
  printCount(out, counters.event_array_gaps, "holes in the arrays' sequence numbers");
  printCount(out, counters.events_late, "dropped: older than those before");
  printCount(out, counters.events_outside, "dropped: not on the sensor");
  printCount(out, counters.events_glitched, "dropped: an unconfirmed jump of time");
  printCount(out, counters.events_overflowed, "dropped: max_buffered_events reached");
  printCount(out, counters.event_time_jumps, "jumps of the events' time");
  printCount(out, counters.size_changes, "changes of the sensor's size");
  out << "exposures\n";
  out << "  " << std::setw(10) << counters.exposures_in << "  in\n";
  printCount(out, counters.exposures_refused, "refused: not within 0 to 1 s");
  printCount(out, counters.exposures_surplus, "surplus");
  printCount(out, counters.exposures_missing, "missing");
  out << "messages\n";
  out << "  " << std::setw(10) << report.messages << "  copied\n";
  printCount(out, report.malformed_messages, "malformed: copied, not used");
  const std::ios_base::fmtflags flags = out.flags();
  const std::streamsize precision = out.precision();
  out << std::fixed << std::setprecision(2) << report.seconds << " s, " << std::setprecision(1)
      << report.eventsPerMicrosecond() << " Mev/s\n";
  out.flags(flags);
  out.precision(precision);
}

BagDeblurrer::BagDeblurrer(BagReader& reader, BagWriter& writer, const TopicNames& topics,
                           const LoadedParameters& parameters, Progress progress)
    : reader_(reader),
      writer_(writer),
      topics_(topics),
      progress_(std::move(progress)),
      sink_(parameters.ros.frame_id,
            [this](const sensor_msgs::ImagePtr& image, const sensor_msgs::CameraInfoPtr& info,
                   const OutputFrame&) {
              // Written later: the pipeline's calls must not throw, a full disk does.
              outputs_.push_back({image, info});
            }),
      deblurrer_(parameters.deblur, sink_) {}

BagDeblurReport BagDeblurrer::run() {
  const auto start = std::chrono::steady_clock::now();
  BagMessage message;
  while (reader_.next(message)) {
    writer_.copy(message);
    ++report_.messages;
    report_.last_record_time = message.time;
    const auto now_ns = static_cast<std::int64_t>(message.time.toNSec());
    deblurrer_.advance(now_ns);
    if (!use(message, now_ns)) {
      ++report_.malformed_messages;
    }
    writeOutputs(message.time);
    progress_(reader_.position(), reader_.messageCount());
  }
  deblurrer_.finish();
  writeOutputs(report_.last_record_time);
  report_.counters = deblurrer_.counters();
  report_.damage = reader_.damage();
  report_.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return report_;
}

BagDeblurrer::Use BagDeblurrer::useOf(const BagConnection& connection) const {
  if (connection.topic == topics_.events) {
    return Use::kEvents;
  }
  if (connection.topic == topics_.image) {
    return Use::kImage;
  }
  if (connection.topic == topics_.exposure) {
    return Use::kExposure;
  }
  return connection.topic == topics_.cameraInfo() ? Use::kCameraInfo : Use::kNone;
}

bool BagDeblurrer::use(const BagMessage& message, std::int64_t now_ns) {
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

void BagDeblurrer::writeOutputs(const ros::Time& record_time) {
  for (const Output& output : outputs_) {
    writer_.write(topics_.outputImage(), record_time, *output.image);
    writer_.write(topics_.outputCameraInfo(), record_time, *output.info);
    ++report_.outputs;
  }
  outputs_.clear();
}

}  // namespace fast_edi
