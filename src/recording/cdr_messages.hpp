/// \file
/// Messages of ROS 2, field by field: sensor_msgs and std_msgs/Header. Callers check
/// CdrReader::ok() first: of a message that ends within its fields, no other fault is reported.
#pragma once

#include <cstdint>
#include <string>

#include "fast_edi/recording/picture_decoder.hpp"
#include "fast_edi/recording/recording.hpp"
#include "recording/cdr_reader.hpp"
#include "recording/ros_image.hpp"

namespace fast_edi {

/// std_msgs/Header.
/// \return its stamp [ns]
std::int64_t readHeader(CdrReader& cdr);

/// {0, 0} for an impossible size.
SensorSize sizeOf(std::uint32_t width, std::uint32_t height);

/// sensor_msgs/Image; the pixels stay where they are.
/// \return its stamp [ns]
std::int64_t readImage(CdrReader& cdr, RosImage& image);

/// sensor_msgs/CompressedImage; the picture stays where it is.
/// \return its stamp [ns]
std::int64_t readCompressedImage(CdrReader& cdr, CompressedPicture& picture);

/// sensor_msgs/Imu.
/// \return what is wrong; empty if nothing is
std::string readImu(CdrReader& cdr, RecordedImu& sample);

/// sensor_msgs/CameraInfo.
/// \return what is wrong; empty if nothing is
std::string readCalibration(CdrReader& cdr, RecordedCalibration& calibration);

}  // namespace fast_edi
