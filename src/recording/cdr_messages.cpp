#include "recording/cdr_messages.hpp"

#include <cstddef>

#include "fast_edi/base/sensor_size.hpp"
#include "fast_edi/exposure/stamp_limits.hpp"

namespace fast_edi {
namespace {

constexpr std::uint32_t kMaxSide = kMaxSide_px;
constexpr std::size_t kMaxDistortion = 64;
// Numbers in fields of sensor_msgs/Imu.
constexpr std::size_t kQuaternion = 4;
constexpr std::size_t kCovariance = 9;

}  // namespace

std::int64_t readHeader(CdrReader& cdr) {
  const auto seconds = cdr.number<std::int32_t>();
  const auto nanoseconds = cdr.number<std::uint32_t>();
  cdr.text();  // frame_id
  return seconds * kNanosecondsPerSecond + nanoseconds;
}

SensorSize sizeOf(std::uint32_t width, std::uint32_t height) {
  return width <= kMaxSide && height <= kMaxSide
             ? SensorSize{static_cast<int>(width), static_cast<int>(height)}
             : SensorSize{};
}

std::int64_t readImage(CdrReader& cdr, RosImage& image) {
  const std::int64_t stamp_ns = readHeader(cdr);
  image.height = cdr.number<std::uint32_t>();
  image.width = cdr.number<std::uint32_t>();
  image.encoding = cdr.text();
  image.big_endian = cdr.number<std::uint8_t>() != 0;
  image.step = cdr.number<std::uint32_t>();
  const CdrBytes data = cdr.bytes();
  image.data = data.data;
  image.bytes = data.size;
  return stamp_ns;
}

std::int64_t readCompressedImage(CdrReader& cdr, CompressedPicture& picture) {
  const std::int64_t stamp_ns = readHeader(cdr);
  picture.format = cdr.text();
  const CdrBytes data = cdr.bytes();
  picture.data = data.data;
  picture.bytes = data.size;
  return stamp_ns;
}

std::string readImu(CdrReader& cdr, RecordedImu& sample) {
  sample.t_ns = readHeader(cdr);
  cdr.skipDoubles(kQuaternion + kCovariance);
  cdr.doubles(sample.angular_velocity.data(), sample.angular_velocity.size());
  cdr.skipDoubles(kCovariance);
  cdr.doubles(sample.acceleration.data(), sample.acceleration.size());
  return isStamp(sample.t_ns) ? "" : "an IMU sample with a time before 1970 or after 2106";
}

std::string readCalibration(CdrReader& cdr, RecordedCalibration& calibration) {
  readHeader(cdr);
  const auto height = cdr.number<std::uint32_t>();
  const auto width = cdr.number<std::uint32_t>();
  calibration.size = sizeOf(width, height);
  calibration.distortion_model = std::string(cdr.text());
  const auto count = cdr.number<std::uint32_t>();
  if (count > kMaxDistortion) {
    return "a calibration with " + std::to_string(count) +
           " coefficients of distortion, expected at most " + std::to_string(kMaxDistortion);
  }
  calibration.distortion.resize(count);
  cdr.doubles(calibration.distortion.data(), count);
  cdr.doubles(calibration.camera_matrix.data(), calibration.camera_matrix.size());
  cdr.doubles(calibration.rectification.data(), calibration.rectification.size());
  cdr.doubles(calibration.projection.data(), calibration.projection.size());
  return {};
}

}  // namespace fast_edi
