/// \file
/// sensor_msgs <-> the core's views. Nothing here trusts a length that a message states.
#pragma once

#include <string>

#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>

#include "fast_edi/base/image.hpp"

namespace fast_edi {

/// What can be done with an image message.
enum class ImageVerdict {
  kSupported,    ///< to be deblurred
  kUnsupported,  ///< sound, but not an encoding or size that is deblurred: to be passed through
  kMalformed,    ///< its lengths contradict each other: to be refused
};

struct ImageReading {
  ImageVerdict verdict = ImageVerdict::kMalformed;
  ImageView view;      ///< of the message's own memory when supported, else empty (size {0, 0})
  std::string reason;  ///< found and expected, when not supported
};

/// Encodings: mono8, 8UC1, mono16; rgb, bgr, rgba, bgra and raw Bayer of 8 or 16 bits. Those of 16
/// bits must be little endian.
ImageReading readImage(const sensor_msgs::Image& message);

/// An image like \p input, without padding at the end of rows and with undefined pixels.
/// \param format must be the one that readImage() found
sensor_msgs::ImagePtr makeImageLike(const sensor_msgs::Image& input, PixelFormat format);

/// Writable view of an image made by makeImageLike().
MutableImageView viewOf(sensor_msgs::Image& image, PixelFormat format);

/// What is wrong with a calibration; empty if nothing is. Zero K, which means "not calibrated", is
/// no fault; numbers that are not finite are: they would be copied to every output.
std::string cameraInfoFault(const sensor_msgs::CameraInfo& info);

/// The camera_info that belongs to \p image: a copy of \p latest, or, with none received yet, zero
/// K and the image's size; stamp and frame_id are the image's.
sensor_msgs::CameraInfoPtr makeCameraInfo(const sensor_msgs::CameraInfo* latest,
                                          const sensor_msgs::Image& image);

}  // namespace fast_edi
