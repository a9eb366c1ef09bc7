/// \file
/// Walls and furniture of the simulated room.
#pragma once

#include <cstdint>
#include <vector>

#include "scenes/simulation_settings.hpp"
#include "scenes/textured_body.hpp"

namespace fast_edi {

/// What the room shows.
struct RoomBodies {
  TexturedBody walls;                   ///< with floor and ceiling, seen from within
  std::vector<TexturedBody> furniture;  ///< pillars and boxes; none hides another from the lap
};

/// Builds a room of random furniture and textures. World frame: the origin in the middle of the
/// floor, x along the length, z up [m].
/// \throws std::runtime_error when the texture file cannot be read
RoomBodies makeRoomBodies(const RoomSettings& room, const SceneSettings& scene, std::uint64_t seed);

}  // namespace fast_edi
