/// \file
/// rosbag2, the recordings of ROS 2 (https://github.com/ros2/rosbag2): SQLite or MCAP, whole or
/// split over files, compressed by message, by chunk or by file.
///
/// - Events: `EventArray` of dvs_msgs, dv_ros2_msgs, dv_ros_msgs and prophesee_event_msgs;
///   event_camera_msgs/EventPacket (see event_packet_decoder.hpp).
/// - Frames: sensor_msgs/Image, or CompressedImage on TOPIC/compressed where TOPIC was not
/// recorded. If there is a topic `exposure` (std_msgs/Int32, microseconds)
///   beside them, each frame gets its exposure time from the message after it; if the next frame
///   comes first, its exposure is not known.
/// - sensor_msgs/Imu and CameraInfo.
///
/// Streams of one namespace are those of one camera. The only frames of a recording belong to the
/// only events.
#pragma once

#include <memory>
#include <string>

#include "fast_edi/recording/picture_decoder.hpp"
#include "fast_edi/recording/recording.hpp"

namespace fast_edi {

/// \param path of the folder, of its metadata.yaml, or of one file with messages
/// \param decode for compressed frames; without it they are left out, which is noted
/// \throws RecordingError when nothing at all can be read
std::unique_ptr<Recording> openRosbag2(const std::string& path, PictureDecoder decode = nullptr);

}  // namespace fast_edi
