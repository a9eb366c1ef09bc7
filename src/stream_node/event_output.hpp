/// \file
/// Events of a stream as event arrays, one for each packet.
///
/// A subscriber in the same nodelet manager gets the array itself. roscpp hands a pointer over only
/// where the C++ type is the same, so it is the type that EventSubscription takes of a publisher in
/// its process: the generated one in a build with `dvs_msgs`, else EventArray.
#pragma once

#include <cstdint>
#include <string>

#include <ros/node_handle.h>
#include <ros/publisher.h>

#include "stream/stream_client.hpp"

namespace fast_edi {

class EventOutput : public StreamSink {
 public:
  /// Advertises `events`.
  EventOutput(ros::NodeHandle nh, std::string frame_id);

  /// A connection after another leaves a hole in the arrays' header.seq: frames with events missing
  /// are then not deblurred.
  void begin(const RecordedStream& stream) override;
  void add(const RecordingItem& item) override;

 private:
  const std::string frame_id_;
  ros::Publisher publisher_;
  SensorSize size_;
  bool begun_ = false;
  std::uint32_t sequence_ = 0;
};

}  // namespace fast_edi
