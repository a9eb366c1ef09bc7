#include "scenes/world.hpp"

#include <algorithm>
#include <array>

#include "scenes/camera_motion.hpp"
#include "scenes/room.hpp"
#include "scenes/scene.hpp"

namespace fast_edi {
namespace {

/// Renderings per period of a flickering light.
constexpr double kStepsPerFlicker = 40.0;
/// Over which the speed in the room is measured.
constexpr std::int64_t kSpeedStepNs = 10 * kNanosecondsPerMicrosecond;

class PlaneWorld : public World {
 public:
  explicit PlaneWorld(const SimulationSettings& settings)
      : settings_(settings),
        scene_(settings.scene, settings.sensor.size, settings.sensor.colour_filter, settings.seed),
        motion_(settings.motion, settings.sensor.size, settings.focalLengthPx(), settings.seed) {}

  void render(std::int64_t t_ns, cv::Mat1f& irradiance) const override {
    scene_.render(motion_.imageToPlaneAt(sinceStart(t_ns)), t_ns, irradiance);
  }

  double displacementPx(std::int64_t from_ns, std::int64_t to_ns) const override {
    return motion_.displacementPx(sinceStart(from_ns), sinceStart(to_ns));
  }

  double speedPxPerSecond(std::int64_t t_ns) const override {
    return motion_.speedPxPerSecond(sinceStart(t_ns));
  }

  std::int64_t maxStepNs() const override {
    if (settings_.scene.flicker_hz <= 0.0) return kNanosecondsPerSecond;
    return static_cast<std::int64_t>(static_cast<double>(kNanosecondsPerSecond) /
                                     (kStepsPerFlicker * settings_.scene.flicker_hz));
  }

  std::vector<int> visibleTagsAt(std::int64_t t_ns) const override {
    const cv::Matx33d plane_to_image = motion_.imageToPlaneAt(sinceStart(t_ns)).inv();
    const double right = settings_.sensor.size.width - 1;
    const double bottom = settings_.sensor.size.height - 1;
    std::vector<int> visible;
    for (const PlacedTag& tag : scene_.tags()) {
      const std::array<cv::Point2d, 4> corners = tag.corners(kTagPaperFactor);
      const bool inside =
          std::all_of(corners.begin(), corners.end(), [&](const cv::Point2d& corner) {
            const cv::Vec3d p = plane_to_image * cv::Vec3d(corner.x, corner.y, 1.0);
            const double x = p[0] / p[2];
            const double y = p[1] / p[2];
            return x >= 0.0 && x <= right && y >= 0.0 && y <= bottom;
          });
      if (inside) visible.push_back(tag.id);
    }
    return visible;
  }

  const RoomTrajectory* trajectory() const override { return nullptr; }

 private:
  std::int64_t sinceStart(std::int64_t t_ns) const { return t_ns - settings_.timing.start_ns; }

  SimulationSettings settings_;
  Scene scene_;
  CameraMotion motion_;
};

class RoomWorld : public World {
 public:
  explicit RoomWorld(const SimulationSettings& settings)
      : start_ns_(settings.timing.start_ns),
        size_(settings.sensor.size),
        room_(settings.room, settings.scene, settings.sensor.size, settings.focalLengthPx(),
              settings.seed),
        trajectory_(settings.room, settings.lengthNs(), settings.seed) {}

  void render(std::int64_t t_ns, cv::Mat1f& irradiance) const override {
    room_.render(poseAt(t_ns), irradiance);
  }

  double displacementPx(std::int64_t from_ns, std::int64_t to_ns) const override {
    const RigidPose from = poseAt(from_ns);
    const RigidPose to = poseAt(to_ns);
    const double right = size_.width - 1;
    const double bottom = size_.height - 1;
    const std::array<cv::Point2d, 5> pixels{cv::Point2d{0.0, 0.0}, cv::Point2d{right, 0.0},
                                            cv::Point2d{0.0, bottom}, cv::Point2d{right, bottom},
                                            cv::Point2d{0.5 * right, 0.5 * bottom}};
    double largest = 0.0;
    for (const cv::Point2d& pixel : pixels) {
      const Eigen::Vector3d point =
          from.position +
          from.orientation * (room_.depthAt(from, pixel) * room_.camera().rayOf(pixel));
      const Eigen::Vector3d seen = to.orientation.conjugate() * (point - to.position);
      largest = std::max(largest, cv::norm(room_.camera().project(seen) - pixel));
    }
    return largest;
  }

  double speedPxPerSecond(std::int64_t t_ns) const override {
    return displacementPx(t_ns, t_ns + kSpeedStepNs) * static_cast<double>(kNanosecondsPerSecond) /
           static_cast<double>(kSpeedStepNs);
  }

  std::int64_t maxStepNs() const override { return kNanosecondsPerSecond; }
  std::vector<int> visibleTagsAt(std::int64_t /*t_ns*/) const override { return {}; }
  const RoomTrajectory* trajectory() const override { return &trajectory_; }

 private:
  RigidPose poseAt(std::int64_t t_ns) const { return trajectory_.poseAt(t_ns - start_ns_); }

  std::int64_t start_ns_;
  SensorSize size_;
  Room room_;
  RoomTrajectory trajectory_;
};

}  // namespace

std::unique_ptr<const World> makeWorld(const SimulationSettings& settings) {
  if (settings.kind == SceneKind::kRoom) return std::make_unique<RoomWorld>(settings);
  return std::make_unique<PlaneWorld>(settings);
}

}  // namespace fast_edi
