#include "fast_edi/parameters/parameters.hpp"
#include "fast_edi/base/parameter_ranges.hpp"

#include <functional>
#include <limits>
#include <stdexcept>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fast_edi {
namespace {

using ::testing::HasSubstr;

DeblurParameters validParameters() {
  DeblurParameters parameters;
  parameters.thresholds = {0.3, 0.25};
  return parameters;
}

TEST(Parameters, DefaultsWithThresholdsAreValid) {
  EXPECT_NO_THROW(validate(validParameters()));
}

TEST(Parameters, ThresholdsHaveNoDefault) {
  EXPECT_THROW(validate(DeblurParameters{}), std::invalid_argument);
}

struct BadValue {
  std::string name;  ///< must be in the message
  std::function<void(DeblurParameters&)> set;
};

TEST(Parameters, EveryValueOutOfRangeIsNamed) {
  const BadValue bad_values[] = {
      {"contrast_threshold_on", [](auto& p) { p.thresholds.on = 0.0; }},
      {"contrast_threshold_on",
       [](auto& p) { p.thresholds.on = std::numeric_limits<double>::quiet_NaN(); }},
      {"contrast_threshold_off", [](auto& p) { p.thresholds.off = -0.1; }},
      {"contrast_threshold_off",
       [](auto& p) { p.thresholds.off = std::numeric_limits<double>::infinity(); }},
      {"exposure_time_us", [](auto& p) { p.exposure_time_ns = -1; }},
      {"exposure_time_us", [](auto& p) { p.exposure_time_ns = kMaxExposure_ns + 1; }},
      {"time_offset_us", [](auto& p) { p.time_offset_ns = kMaxTimeOffset_ns + 1; }},
      {"time_offset_us", [](auto& p) { p.time_offset_ns = -kMaxTimeOffset_ns - 1; }},
      {"exposure_time_us", [](auto& p) { p.exposure_time_ns = 999; }},
      {"close_timeout_ms", [](auto& p) { p.close_timeout_ns = 999'999; }},
      {"max_backward_jump_ms", [](auto& p) { p.max_backward_jump_ns = 0; }},
      {"max_forward_jump_ms", [](auto& p) { p.max_forward_jump_ns = 3'600'000'000'001; }},
      {"filter_gain_noise", [](auto& p) { p.filter.gain.noise = 1e-20F; }},
      {"filter_gain_sigma_px", [](auto& p) { p.filter.gain.spatial_sigma_px = 1e-20F; }},
      {"filter_frame_noise_kept", [](auto& p) { p.filter.frame_noise_kept = 1.1; }},
      {"frame_noise_dn", [](auto& p) { p.filter.frame_noise_dn = 1e-20; }},
      {"max_buffered_events", [](auto& p) { p.max_buffered_events = 0; }},
  };
  for (const BadValue& bad : bad_values) {
    DeblurParameters parameters = validParameters();
    bad.set(parameters);
    try {
      validate(parameters);
      ADD_FAILURE() << bad.name << " was accepted";
    } catch (const std::invalid_argument& error) {
      EXPECT_THAT(error.what(), HasSubstr(bad.name));
      EXPECT_THAT(error.what(), HasSubstr("expected"));
    }
  }
}

TEST(ExposureInterval, MiddleIsInWholeMicrosecondsAfterTheStart) {
  constexpr std::int64_t kUs = kNanosecondsPerMicrosecond;
  const ExposureInterval odd{5, 5 + 31 * kUs};
  EXPECT_EQ(odd.at(ExposureInstant::kStart), 5);
  EXPECT_EQ(odd.at(ExposureInstant::kMid), 5 + 15 * kUs);
  EXPECT_EQ(odd.at(ExposureInstant::kEnd), 5 + 31 * kUs);
}

}  // namespace
}  // namespace fast_edi
