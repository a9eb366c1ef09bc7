#include "config/driver_keys.hpp"

#include <gtest/gtest.h>

namespace fast_edi {
namespace {

TEST(DriverKeys, AreBiasesAndSettingsOfTheDriver) {
  for (const char* name : {"PrBp_coarse",
                           "PrBp_fine",
                           "ADC_RefHigh_volt",
                           "ADC_RefHigh_curr",
                           "x_fine",
                           "aps_enabled",
                           "autoexposure_gain",
                           "dvs_enabled",
                           "background_activity_filter_time",
                           "frame_delay",
                           "imu_enabled",
                           "pixel_0_row",
                           "polarity_flatten",
                           "roi_start_row",
                           "refractory_period_time",
                           "skip_every",
                           "reset_timestamps_x",
                           "max_events",
                           "streaming_rate",
                           "exposure",
                           "groups",
                           "master",
                           "serial_number"}) {
    EXPECT_TRUE(isDriverKey(name)) << name;
  }
}

TEST(DriverKeys, HaveANameBeforeTheirEnding) {
  for (const char* name : {"", "_coarse", "_fine", "_volt", "_curr", "coarse", "PrBp_coarse_",
                           "masters", "exposure_time_us", "group", "x_aps_enabled"}) {
    EXPECT_FALSE(isDriverKey(name)) << name;
  }
}

}  // namespace
}  // namespace fast_edi
