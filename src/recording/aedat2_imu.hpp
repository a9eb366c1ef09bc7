/// \file
#pragma once

#include <cstdint>

#include "fast_edi/recording/recording.hpp"

namespace fast_edi {

/// Assembles the IMU samples of AEDAT2, whose numbers come one by one: acceleration, temperature,
/// angular velocity. They are scaled for 8 g and 500 deg/s of 16 bits, jAER's setting.
class Aedat2Imu {
 public:
  /// Of a sample.
  static constexpr std::uint32_t kNumbers = 7;

  /// \param code which number of the sample it is. \pre code < kNumbers
  /// \param t_ns of the sample, when this is its last number
  /// \return whether it completes a sample; one of which a number is missing never is complete
  bool add(std::uint32_t code, std::int16_t number, std::int64_t t_ns);
  /// The sample that add() has completed.
  const RecordedImu& sample() const { return sample_; }

 private:
  RecordedImu sample_;
  std::uint32_t code_ = 0;  ///< of the last number
  bool whole_ = false;      ///< no number before code_ is missing
};

}  // namespace fast_edi
