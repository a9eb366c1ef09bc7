/// \file
/// Procedural textures for the simulated plane.
#pragma once

#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "scenes/april_tags.hpp"
#include "scenes/random.hpp"
#include "scenes/simulation_settings.hpp"

namespace fast_edi {

/// Reflectances stay within these bounds: no surface is perfectly black or white.
constexpr float kMinReflectance = 0.02F;
constexpr float kMaxReflectance = 1.0F;

/// Draws a texture of linear RGB reflectance.
/// \param size_px of the plane [px of the nominal view]
/// \param scale canvas elements per px
/// \param density see SceneSettings
/// \param tags stickers of kPoster keep clear of them
cv::Mat3f drawTexture(TextureKind kind, cv::Size size_px, double scale, double density,
                      const std::vector<PlacedTag>& tags, RandomEngine& random);

/// Reads a picture as linear RGB reflectance. It fills the view (cropped to its aspect ratio) and
/// goes on mirrored beyond it.
/// \throws std::runtime_error when the file is not a readable picture
cv::Mat3f loadTexture(const std::string& path, cv::Size size_px, SensorSize view, double scale);

}  // namespace fast_edi
