/// \file
/// IMU samples and triggers of streams.
#pragma once

#include <cstdint>

#include <ros/node_handle.h>
#include <ros/publisher.h>

#include "stream/stream_client.hpp"

namespace fast_edi {

/// Publishes `imu`.
class ImuOutput : public StreamSink {
 public:
  explicit ImuOutput(ros::NodeHandle nh);
  void begin(const RecordedStream& stream) override;
  void add(const RecordingItem& item) override;

 private:
  ros::Publisher publisher_;
  std::uint32_t sequence_ = 0;
};

/// Publishes `triggers`: each as sensor_msgs/TimeReference, whose `source` is the type of the
/// trigger as DV numbers them. The DAVIS driver has no such topic.
class TriggerOutput : public StreamSink {
 public:
  explicit TriggerOutput(ros::NodeHandle nh);
  void begin(const RecordedStream& stream) override;
  void add(const RecordingItem& item) override;

 private:
  ros::Publisher publisher_;
  std::uint32_t sequence_ = 0;
};

}  // namespace fast_edi
