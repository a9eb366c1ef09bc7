/// \file
/// Event sensors that differ in more than numbers: what a method must get along with that does not
/// know the camera it will meet.
///
/// | name       | what it stands for | source |
/// |------------|--------------------|--------|
/// | none       | ideal frames and events | |
/// | clean      | 2 % mismatch, nothing else | |
/// | typical    | DAVIS346 with libcaer's biases, unlimited bandwidth | SensorSettings |
/// | davis346   | the same with a photoreceptor of 300 (bright) to 30 Hz (dark) | SensorSettings |
/// | davis240   | more leak and shot noise, 96 us refractory period, noisier frames | |
/// | strong     | a warm or slowly biased sensor, single hot pixels | |
/// | mismatch   | thresholds spread by 15 % | |
/// | refractory | 1 ms refractory period | |
/// | slow       | v2e at 200 Hz: bandwidth ~ I + 20 DN, linear below 20 DN | Hu et al. 2021 |
/// | slow-noisy | v2e's noisy preset: 30 Hz, leak, shot noise, 0.5 ms refractory | the same |
#pragma once

#include <string>
#include <vector>

#include "scenes/simulation_settings.hpp"

namespace fast_edi {

/// In the order of the table above.
std::vector<std::string> sensorModelNames();

/// The sensor of that name; its size, thresholds' means and the frames' white level are the
/// defaults.
/// \throws std::invalid_argument listing the names that are known
SensorSettings sensorModel(const std::string& name);

}  // namespace fast_edi
