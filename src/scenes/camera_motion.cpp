#include "scenes/camera_motion.hpp"

#include <algorithm>
#include <cmath>

#include <boost/random/uniform_real_distribution.hpp>

#include "scenes/random.hpp"

namespace fast_edi {
namespace {

enum Axis { kX, kY, kHeight, kYaw, kPitch, kRoll };

/// A sinusoid of a preset. Frequency and phase are drawn from the seed.
struct Band {
  Axis axis;
  double amplitude;  ///< px for kX, kY, kYaw, kPitch (angles as the shift they cause); rad for
                     ///< kRoll; relative for kHeight
  double low_hz;
  double high_hz;
};

std::vector<Band> bands(MotionKind kind) {
  switch (kind) {
    case MotionKind::kStill:
      return {};
    case MotionKind::kMild:
      return {{kX, 12.0, 0.5, 1.0},
              {kYaw, 9.0, 1.0, 1.6},
              {kPitch, 8.0, 1.0, 1.6},
              {kRoll, 0.02, 0.8, 1.2},
              {kHeight, 0.02, 0.5, 0.8}};
    case MotionKind::kPan:
      return {{kX, 85.0, 0.8, 1.0}, {kPitch, 4.0, 1.0, 2.0}, {kRoll, 0.01, 0.8, 1.2}};
    case MotionKind::kSpin:
      return {{kRoll, 0.5, 1.2, 1.6}, {kYaw, 3.0, 1.0, 2.0}, {kPitch, 3.0, 1.0, 2.0}};
    case MotionKind::kShake:
      return {{kX, 10.0, 1.0, 2.0},     {kYaw, 20.0, 4.0, 5.5},   {kYaw, 6.0, 8.0, 10.0},
              {kPitch, 17.0, 4.0, 5.5}, {kPitch, 5.0, 8.0, 10.0}, {kRoll, 0.03, 3.0, 4.0},
              {kHeight, 0.02, 1.0, 2.0}};
  }
  return {};
}

cv::Point2d project(const cv::Matx33d& h, const cv::Point2d& point) {
  const cv::Vec3d p = h * cv::Vec3d(point.x, point.y, 1.0);
  return {p[0] / p[2], p[1] / p[2]};
}

}  // namespace

CameraMotion::CameraMotion(const MotionSettings& settings, SensorSize size, double focal_length_px,
                           std::uint64_t seed)
    : size_(size), focal_length_px_(focal_length_px) {
  RandomEngine random = makeRandomEngine(seed, RandomStream::kMotion);
  for (const Band& band : bands(settings.kind)) {
    const double to_unit = band.axis == kYaw || band.axis == kPitch ? 1.0 / focal_length_px : 1.0;
    Wave wave{};
    wave.amplitude = settings.scale * band.amplitude * to_unit;
    wave.frequency_hz =
        boost::random::uniform_real_distribution<double>(band.low_hz, band.high_hz)(random);
    wave.phase_rad = boost::random::uniform_real_distribution<double>(0.0, 2.0 * CV_PI)(random);
    waves_[band.axis].push_back(wave);
  }
}

double CameraMotion::sum(int axis, double t_s) const {
  double value = 0.0;
  for (const Wave& wave : waves_[static_cast<std::size_t>(axis)]) {
    value += wave.amplitude * std::sin(2.0 * CV_PI * wave.frequency_hz * t_s + wave.phase_rad);
  }
  return value;
}

CameraPose CameraMotion::poseAt(std::int64_t t_ns) const {
  const double t_s = static_cast<double>(t_ns) / static_cast<double>(kNanosecondsPerSecond);
  CameraPose pose;
  pose.x_px = sum(kX, t_s);
  pose.y_px = sum(kY, t_s);
  pose.height = sum(kHeight, t_s);
  pose.yaw_rad = sum(kYaw, t_s);
  pose.pitch_rad = sum(kPitch, t_s);
  pose.roll_rad = sum(kRoll, t_s);
  return pose;
}

cv::Matx33d CameraMotion::imageToPlaneAt(std::int64_t t_ns) const {
  const CameraPose pose = poseAt(t_ns);
  const double f = focal_length_px_;
  const cv::Matx33d ray(1.0 / f, 0.0, -0.5 * (size_.width - 1) / f,   //
                        0.0, 1.0 / f, -0.5 * (size_.height - 1) / f,  //
                        0.0, 0.0, 1.0);
  const double cy = std::cos(pose.yaw_rad);
  const double sy = std::sin(pose.yaw_rad);
  const double cp = std::cos(pose.pitch_rad);
  const double sp = std::sin(pose.pitch_rad);
  const double cr = std::cos(pose.roll_rad);
  const double sr = std::sin(pose.roll_rad);
  const cv::Matx33d yaw(cy, 0.0, sy, 0.0, 1.0, 0.0, -sy, 0.0, cy);
  const cv::Matx33d pitch(1.0, 0.0, 0.0, 0.0, cp, -sp, 0.0, sp, cp);
  const cv::Matx33d roll(cr, -sr, 0.0, sr, cr, 0.0, 0.0, 0.0, 1.0);
  // A ray d from (x, y) at height f (1 + h) meets the plane at (x, y) + f (1 + h) d_xy / d_z.
  const double distance = f * (1.0 + pose.height);
  const cv::Matx33d meet(distance, 0.0, pose.x_px, 0.0, distance, pose.y_px, 0.0, 0.0, 1.0);
  return meet * yaw * pitch * roll * ray;
}

double CameraMotion::displacementPx(std::int64_t from_ns, std::int64_t to_ns) const {
  const cv::Matx33d way = imageToPlaneAt(to_ns).inv() * imageToPlaneAt(from_ns);
  const double right = size_.width - 1;
  const double bottom = size_.height - 1;
  const std::array<cv::Point2d, 5> points{cv::Point2d{0.0, 0.0}, cv::Point2d{right, 0.0},
                                          cv::Point2d{0.0, bottom}, cv::Point2d{right, bottom},
                                          cv::Point2d{0.5 * right, 0.5 * bottom}};
  double largest = 0.0;
  for (const cv::Point2d& point : points) {
    largest = std::max(largest, cv::norm(project(way, point) - point));
  }
  return largest;
}

double CameraMotion::speedPxPerSecond(std::int64_t t_ns) const {
  constexpr std::int64_t kStepNs = 10 * kNanosecondsPerMicrosecond;
  return displacementPx(t_ns, t_ns + kStepNs) * static_cast<double>(kNanosecondsPerSecond) /
         static_cast<double>(kStepNs);
}

}  // namespace fast_edi
