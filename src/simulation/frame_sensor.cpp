#include "simulation/frame_sensor.hpp"

#include <cmath>

#include <boost/random/normal_distribution.hpp>

#include "fast_edi/base/image.hpp"

namespace fast_edi {
namespace {

constexpr double kMax8 = 255.0;

cv::Mat quantise(const cv::Mat1f& dn, int bits) {
  cv::Mat frame;
  if (bits == 16) {
    dn.convertTo(frame, CV_16U, kDn16PerDn8);
  } else {
    dn.convertTo(frame, CV_8U);
  }
  return frame;
}

}  // namespace

FrameSensor::FrameSensor(const SensorSettings& settings, std::uint64_t seed)
    : settings_(settings), random_(makeRandomEngine(seed, RandomStream::kFrameNoise)) {}

cv::Mat FrameSensor::expose(const cv::Mat1f& irradiance) {
  cv::Mat1f dn = irradiance * settings_.white_dn;
  const double shot_variance_per_dn =
      settings_.electrons_per_dn > 0.0 ? 1.0 / settings_.electrons_per_dn : 0.0;
  const double read_variance = settings_.read_noise_dn * settings_.read_noise_dn;
  if (shot_variance_per_dn > 0.0 || read_variance > 0.0) {
    boost::random::normal_distribution<double> normal;
    for (float& value : dn) {
      // A full photosite collects nothing more, hence no more noise.
      const double signal = std::fmin(value, kMax8);
      const double sigma = std::sqrt(read_variance + shot_variance_per_dn * signal);
      value += static_cast<float>(sigma * normal(random_));
    }
  }
  return quantise(dn, settings_.frame_bits);
}

cv::Mat FrameSensor::noiseFree(const cv::Mat1f& irradiance) const {
  return quantise(irradiance * settings_.white_dn, settings_.frame_bits);
}

}  // namespace fast_edi
