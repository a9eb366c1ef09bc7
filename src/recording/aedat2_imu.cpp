#include "recording/aedat2_imu.hpp"

#include "recording/imu_units.hpp"

namespace fast_edi {
namespace {

constexpr std::uint32_t kTemperature = 3;

constexpr double kAccelerationScale = kStandardGravity / 4096.0;  ///< m/s^2
constexpr double kAngularScale = kRadiansPerDegree / 65.5;        ///< rad/s

}  // namespace

bool Aedat2Imu::add(std::uint32_t code, std::int16_t number, std::int64_t t_ns) {
  whole_ = code == 0 || (whole_ && code == code_ + 1);
  code_ = code;
  if (code < kTemperature) {
    sample_.acceleration[code] = number * kAccelerationScale;
  } else if (code > kTemperature) {
    sample_.angular_velocity[code - kTemperature - 1] = number * kAngularScale;
  }
  if (code + 1 < kNumbers || !whole_) {
    return false;
  }
  whole_ = false;
  sample_.t_ns = t_ns;
  return true;
}

}  // namespace fast_edi
