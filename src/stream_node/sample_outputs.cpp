#include "stream_node/sample_outputs.hpp"

#include <string>
#include <variant>

#include <sensor_msgs/Imu.h>
#include <sensor_msgs/TimeReference.h>
#include <boost/make_shared.hpp>

#include "messages/recorded_messages.hpp"

namespace fast_edi {
namespace {

/// Messages that wait for a subscriber in another process: a second at 1000 Hz.
constexpr std::uint32_t kSampleQueue = 1000;

}  // namespace

ImuOutput::ImuOutput(ros::NodeHandle nh)
    : publisher_(nh.advertise<sensor_msgs::Imu>("imu", kSampleQueue)) {}

void ImuOutput::begin(const RecordedStream&) {}

void ImuOutput::add(const RecordingItem& item) {
  if (const auto* sample = std::get_if<RecordedImu>(&item.content)) {
    auto message = boost::make_shared<sensor_msgs::Imu>();
    message->header.seq = sequence_++;
    fillImu(*sample, *message);
    publisher_.publish(message);
  }
}

TriggerOutput::TriggerOutput(ros::NodeHandle nh)
    : publisher_(nh.advertise<sensor_msgs::TimeReference>("triggers", kSampleQueue)) {}

void TriggerOutput::begin(const RecordedStream&) {}

void TriggerOutput::add(const RecordingItem& item) {
  if (const auto* trigger = std::get_if<RecordedTrigger>(&item.content)) {
    auto message = boost::make_shared<sensor_msgs::TimeReference>();
    message->header.seq = sequence_++;
    message->header.stamp = stampOf(trigger->t_ns);
    message->time_ref = message->header.stamp;
    message->source = std::to_string(trigger->type);
    publisher_.publish(message);
  }
}

}  // namespace fast_edi
