/// \file
/// rosbag2, the recordings of ROS 2 (https://github.com/ros2/rosbag2): SQLite or MCAP, whole or
/// split over files, compressed by message, by chunk or by file.
///
/// - Events: `EventArray` of dvs_msgs, dv_ros2_msgs, dv_ros_msgs and prophesee_event_msgs;
///   event_camera_msgs/EventPacket (see event_packet_decoder.hpp).
/// - Frames: sensor_msgs/Image. Where there is a topic `exposure` (std_msgs/Int32, microseconds)
/// beside
///   them, each waits for the message behind it, whose exposure it has; one that is followed by the
///   next frame first has no known exposure.
/// - sensor_msgs/Imu and CameraInfo.
///
/// Streams of one namespace are those of one camera. The only frames of a recording belong to the
/// only events.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "fast_edi/recording/recording.hpp"

namespace fast_edi {

class Rosbag2Reader : public Recording {
 public:
  /// More events of one message come in several items.
  static constexpr std::size_t kMaxItemEvents = 100'000;

  /// \param path of the folder, of its metadata.yaml, or of one file with messages
  /// \throws RecordingError when nothing at all can be read
  explicit Rosbag2Reader(const std::string& path);
  ~Rosbag2Reader() override;

  std::string format() const override;
  const std::vector<RecordedStream>& streams() const override;
  bool next(RecordingItem& item) override;
  const std::vector<RecordingDamage>& damage() const override;
  std::uint64_t position() const override;
  std::uint64_t length() const override;
  std::uint64_t fileSize() const override;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fast_edi
