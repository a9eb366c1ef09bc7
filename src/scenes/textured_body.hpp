/// \file
/// What the simulated room is made of: textured rectangles.
#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <opencv2/core.hpp>

namespace fast_edi {

/// Levels of a face's texture.
constexpr int kTextureLevels = 6;
/// A pixel is given the level at which it covers this many texels on a side.
constexpr double kLevelTexelsPerPixel = 2.0;

/// A level of a texture's pyramid, already blurred by lens and photodiode area.
struct TextureLevel {
  cv::Mat1f texels;
  float u_scale = 1.0F;  ///< of texel coordinates against those of the finest level
  float v_scale = 1.0F;
};

/// A rectangle, seen from where its normal v x u points to; from there its texture is not
/// mirrored.
struct TexturedFace {
  Eigen::Vector3d centre;
  Eigen::Vector3d u;  ///< unit vectors along the texture's columns and rows
  Eigen::Vector3d v;
  double width_m;  ///< along u
  double height_m;
  std::vector<TextureLevel> levels;  ///< kTextureLevels, the finest first

  Eigen::Vector3d normal() const { return v.cross(u); }
};

/// Faces that a convex body shows; of its faces none hides another.
struct TexturedBody {
  Eigen::Vector3d centre;
  std::vector<TexturedFace> faces;
};

}  // namespace fast_edi
