/// \file
/// The frame part of the simulated pixel array.
#pragma once

#include <cstdint>

#include <opencv2/core.hpp>

#include "scenes/random.hpp"
#include "scenes/simulation_settings.hpp"

namespace fast_edi {

/// Turns mean irradiance into digital numbers by a linear response.
class FrameSensor {
 public:
  FrameSensor(const SensorSettings& settings, std::uint64_t seed);

  /// A frame as the camera delivers it: shot noise, read noise, rounding, clipping. Shot noise is
  /// taken as Gaussian, which at tens of electrons per DN it is.
  /// \param irradiance mean over the exposure, CV_32FC1
  /// \return CV_8UC1 or CV_16UC1
  cv::Mat expose(const cv::Mat1f& irradiance);

  /// The same without noise.
  cv::Mat noiseFree(const cv::Mat1f& irradiance) const;

 private:
  SensorSettings settings_;
  RandomEngine random_;
};

}  // namespace fast_edi
