/// \file
/// What a recording or a stream holds, as the messages that davis_ros_driver publishes.
#pragma once

#include <cstdint>

#include <ros/time.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/Imu.h>
#include <std_msgs/Int32.h>

#include "fast_edi/base/types.hpp"
#include "fast_edi/recording/recording.hpp"

namespace fast_edi {

/// A time outside of those that a stamp can hold becomes the first or last of them.
ros::Time stampOf(std::int64_t t_ns);

/// Copies stamp, size, encoding and pixels.
void fillImage(const RecordedFrame& frame, sensor_msgs::Image& image);

/// Length of an exposure [us].
std_msgs::Int32 exposureMessage(const ExposureInterval& exposure);

/// Copies stamp and sample; no orientation.
void fillImu(const RecordedImu& sample, sensor_msgs::Imu& message);

}  // namespace fast_edi
