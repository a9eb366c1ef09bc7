#include "simulation/sensor_models.hpp"

#include <stdexcept>

#include <gmock/gmock.h>

namespace fast_edi {
namespace {

TEST(SensorModelsTest, EachNameGivesAValidSensor) {
  for (const std::string& name : sensorModelNames()) {
    SimulationSettings settings;
    settings.sensor = sensorModel(name);
    EXPECT_NO_THROW(settings.validate()) << name;
  }
}

TEST(SensorModelsTest, UnknownNamesAreRefusedWithTheKnownOnes) {
  try {
    sensorModel("loud");
    FAIL() << "expected an exception";
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("expected one of none, clean, typical"));
    EXPECT_THAT(error.what(), testing::HasSubstr("got \"loud\""));
  }
}

TEST(SensorModelsTest, ACleanSensorHasMismatchAlone) {
  const SensorSettings clean = sensorModel("clean");
  EXPECT_DOUBLE_EQ(clean.threshold_mismatch, 0.02);
  EXPECT_EQ(clean.shot_noise_bright_hz + clean.shot_noise_dark_hz + clean.leak_rate_hz, 0.0);
  EXPECT_EQ(clean.read_noise_dn + clean.electrons_per_dn, 0.0);
  EXPECT_EQ(clean.refractory_ns, 0);
}

TEST(SensorModelsTest, ASlowSensorIsSlowerInTheDark) {
  for (const char* name : {"slow", "slow-noisy"}) {
    const SensorSettings slow = sensorModel(name);
    EXPECT_DOUBLE_EQ(slow.photoreceptor_dark_hz * 275.0, slow.photoreceptor_bright_hz * 20.0);
    EXPECT_DOUBLE_EQ(slow.linear_below_dn, 20.0);
  }
  EXPECT_DOUBLE_EQ(sensorModel("slow").photoreceptor_bright_hz, 200.0);
  EXPECT_DOUBLE_EQ(sensorModel("slow-noisy").photoreceptor_bright_hz, 30.0);
}

}  // namespace
}  // namespace fast_edi
