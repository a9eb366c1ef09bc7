#include "simulation/imu_sensor.hpp"

#include <cmath>

#include <boost/random/normal_distribution.hpp>

namespace fast_edi {

ImuSample idealImuSample(const RigidMotion& motion, std::int64_t t_ns) {
  ImuSample sample;
  sample.t_ns = t_ns;
  sample.angular_velocity = motion.angular_velocity;
  sample.linear_acceleration = motion.pose.orientation.conjugate() *
                               (motion.acceleration + Eigen::Vector3d(0.0, 0.0, kGravity));
  return sample;
}

ImuSensor::ImuSensor(const ImuSettings& settings, std::int64_t start_ns, std::uint64_t seed)
    : settings_(settings),
      start_ns_(start_ns),
      random_(makeRandomEngine(seed, RandomStream::kImu)),
      gyroscope_bias_(normal(settings.gyroscope_bias)),
      accelerometer_bias_(normal(settings.accelerometer_bias)) {}

Eigen::Vector3d ImuSensor::normal(double deviation) {
  boost::random::normal_distribution<double> unit;
  Eigen::Vector3d vector;
  for (int i = 0; i < 3; ++i) vector[i] = deviation * unit(random_);
  return vector;
}

void ImuSensor::advance(std::int64_t t_ns, const RoomTrajectory& trajectory,
                        std::vector<ImuSample>& samples) {
  const double period_ns = static_cast<double>(kNanosecondsPerSecond) / settings_.rate_hz;
  const double root_rate = std::sqrt(settings_.rate_hz);
  while (true) {
    // From the start each time: periods that are no whole nanoseconds must not add up errors.
    const std::int64_t since_start_ns = std::llround(static_cast<double>(taken_) * period_ns);
    if (start_ns_ + since_start_ns > t_ns) return;
    ImuSample sample =
        idealImuSample(trajectory.motionAt(since_start_ns), start_ns_ + since_start_ns);
    sample.angular_velocity += gyroscope_bias_ + normal(settings_.gyroscope_noise * root_rate);
    sample.linear_acceleration +=
        accelerometer_bias_ + normal(settings_.accelerometer_noise * root_rate);
    samples.push_back(sample);
    gyroscope_bias_ += normal(settings_.gyroscope_walk / root_rate);
    accelerometer_bias_ += normal(settings_.accelerometer_walk / root_rate);
    ++taken_;
  }
}

}  // namespace fast_edi
