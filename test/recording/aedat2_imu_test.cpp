#include "recording/aedat2_imu.hpp"

#include <gtest/gtest.h>

namespace fast_edi {
namespace {

constexpr std::int64_t kTime_ns = 12'000;

TEST(Aedat2Imu, ScalesTheSevenNumbersOfASample) {
  Aedat2Imu imu;
  // 1 g along y and against z, 2 deg/s around z.
  EXPECT_FALSE(imu.add(0, 0, 0));
  EXPECT_FALSE(imu.add(1, 4096, 0));
  EXPECT_FALSE(imu.add(2, -4096, 0));
  EXPECT_FALSE(imu.add(3, 123, 0));  // temperature
  EXPECT_FALSE(imu.add(4, 0, 0));
  EXPECT_FALSE(imu.add(5, 0, 0));
  ASSERT_TRUE(imu.add(6, 131, kTime_ns));
  const RecordedImu& sample = imu.sample();
  EXPECT_EQ(sample.t_ns, kTime_ns);
  EXPECT_DOUBLE_EQ(sample.acceleration[0], 0.0);
  EXPECT_DOUBLE_EQ(sample.acceleration[1], 9.80665);
  EXPECT_DOUBLE_EQ(sample.acceleration[2], -9.80665);
  EXPECT_DOUBLE_EQ(sample.angular_velocity[0], 0.0);
  EXPECT_NEAR(sample.angular_velocity[2], 0.0349065850398866, 1e-12);  // 2 deg/s
}

TEST(Aedat2Imu, LeavesOutSamplesOfWhichANumberIsMissing) {
  for (std::uint32_t missing = 0; missing < Aedat2Imu::kNumbers; ++missing) {
    Aedat2Imu imu;
    for (std::uint32_t code = 0; code < Aedat2Imu::kNumbers; ++code) {
      EXPECT_FALSE(code != missing && imu.add(code, 1, kTime_ns)) << "without " << missing;
    }
    for (std::uint32_t code = 0; code < Aedat2Imu::kNumbers; ++code) {
      EXPECT_EQ(imu.add(code, 1, kTime_ns), code + 1 == Aedat2Imu::kNumbers) << "the next one";
    }
    EXPECT_FALSE(imu.add(Aedat2Imu::kNumbers - 1, 1, kTime_ns)) << "the last number again";
  }
}

}  // namespace
}  // namespace fast_edi
