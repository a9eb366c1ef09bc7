/// \file
/// What a simulated camera sees on its way.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <opencv2/core.hpp>

#include "scenes/room_trajectory.hpp"
#include "scenes/simulation_settings.hpp"

namespace fast_edi {

/// A scene and the camera's motion in it. All times are sensor time.
class World {
 public:
  World() = default;
  virtual ~World() = default;
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  /// Irradiance of every pixel, 1 = white at illumination 1.
  virtual void render(std::int64_t t_ns, cv::Mat1f& irradiance) const = 0;
  /// Largest way that the image of a point in view takes between two instants [px].
  virtual double displacementPx(std::int64_t from_ns, std::int64_t to_ns) const = 0;
  virtual double speedPxPerSecond(std::int64_t t_ns) const = 0;
  /// Longest step that resolves the light's changes [ns].
  virtual std::int64_t maxStepNs() const = 0;
  /// Ids of the tags that are wholly in view.
  virtual std::vector<int> visibleTagsAt(std::int64_t t_ns) const = 0;
  /// The camera's way in space, null for a camera without one. Its times count from the start.
  virtual const RoomTrajectory* trajectory() const = 0;
};

/// \pre the settings are valid
/// \throws std::runtime_error when the texture file cannot be read
std::unique_ptr<const World> makeWorld(const SimulationSettings& settings);

}  // namespace fast_edi
