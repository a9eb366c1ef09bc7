#include "simulation/sensor_models.hpp"

#include <array>
#include <stdexcept>

namespace fast_edi {
namespace {

/// v2e: bandwidth in proportion to I + 20 DN, of 275 at most.
constexpr double kV2eDarkPerBright = 20.0 / 275.0;
constexpr double kV2eLinearBelowDn = 20.0;
/// v2e: shot noise in full light, of that in the dark.
constexpr double kV2eBrightNoisePerDark = 0.25;

SensorSettings clean() {
  SensorSettings sensor = SensorSettings::ideal();
  sensor.threshold_mismatch = 0.02;
  sensor.random_initial_level = true;
  return sensor;
}

SensorSettings typical() {
  return {};
}

SensorSettings davis346() {
  SensorSettings sensor;
  sensor.photoreceptor_bright_hz = 300.0;
  sensor.photoreceptor_dark_hz = 30.0;
  return sensor;
}

SensorSettings davis240() {
  SensorSettings sensor = davis346();
  sensor.threshold_mismatch = 0.06;
  sensor.refractory_ns = 96'000;  // RefrBp (3, 7)
  sensor.leak_rate_hz = 0.2;
  sensor.shot_noise_bright_hz = 1.0;
  sensor.shot_noise_dark_hz = 10.0;
  sensor.read_noise_dn = 2.2;
  sensor.electrons_per_dn = 60.0;
  return sensor;
}

SensorSettings strong() {
  SensorSettings sensor = davis346();
  sensor.threshold_mismatch = 0.10;
  sensor.refractory_ns = 96'000;  // RefrBp (3, 7)
  sensor.leak_rate_hz = 0.3;
  sensor.shot_noise_bright_hz = 1.0;
  sensor.shot_noise_dark_hz = 10.0;
  sensor.hot_pixel_fraction = 1e-4;
  sensor.read_noise_dn = 2.0;
  return sensor;
}

SensorSettings mismatch() {
  SensorSettings sensor;
  sensor.threshold_mismatch = 0.15;
  return sensor;
}

SensorSettings refractory() {
  SensorSettings sensor;
  sensor.threshold_mismatch = 0.05;
  sensor.refractory_ns = 1'000'000;
  sensor.read_noise_dn = 1.0;
  return sensor;
}

SensorSettings slow() {
  SensorSettings sensor = clean();
  sensor.threshold_mismatch = 0.08;
  sensor.photoreceptor_bright_hz = 200.0;
  sensor.photoreceptor_dark_hz = sensor.photoreceptor_bright_hz * kV2eDarkPerBright;
  sensor.linear_below_dn = kV2eLinearBelowDn;
  sensor.read_noise_dn = 1.0;
  return sensor;
}

SensorSettings slowNoisy() {
  SensorSettings sensor = slow();
  sensor.threshold_mismatch = 0.12;
  sensor.photoreceptor_bright_hz = 30.0;
  sensor.photoreceptor_dark_hz = sensor.photoreceptor_bright_hz * kV2eDarkPerBright;
  sensor.refractory_ns = 500'000;
  sensor.leak_rate_hz = 0.1;
  sensor.shot_noise_dark_hz = 5.0;
  sensor.shot_noise_bright_hz = sensor.shot_noise_dark_hz * kV2eBrightNoisePerDark;
  return sensor;
}

struct Model {
  const char* name;
  SensorSettings (*make)();
};

constexpr std::array<Model, 10> kModels{{{"none", SensorSettings::ideal},
                                         {"clean", clean},
                                         {"typical", typical},
                                         {"davis346", davis346},
                                         {"davis240", davis240},
                                         {"strong", strong},
                                         {"mismatch", mismatch},
                                         {"refractory", refractory},
                                         {"slow", slow},
                                         {"slow-noisy", slowNoisy}}};

}  // namespace

std::vector<std::string> sensorModelNames() {
  std::vector<std::string> all;
  for (const Model& model : kModels) all.emplace_back(model.name);
  return all;
}

SensorSettings sensorModel(const std::string& name) {
  std::string known;
  for (const Model& model : kModels) {
    if (name == model.name) return model.make();
    known += (known.empty() ? "" : ", ") + std::string(model.name);
  }
  throw std::invalid_argument("sensor model: expected one of " + known + ", got \"" + name + "\"");
}

}  // namespace fast_edi
