/// \file
/// Draws the textured faces of a body, row by row.
///
/// Every face is drawn by its homography. Textures are sampled bilinearly within a level and
/// linearly between levels; edges of faces are softened over a given width, so that irradiance
/// changes smoothly with the pose.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "scenes/pinhole_camera.hpp"
#include "scenes/room_trajectory.hpp"
#include "scenes/textured_body.hpp"

namespace fast_edi {

/// A function that is linear in the pixel's coordinates (x, y, 1).
struct LinearFunction {
  double x;
  double y;
  double one;
  float slope() const { return static_cast<float>(x); }
};

/// A face as a pose sees it. Points into the face's texture.
struct FaceView {
  /// A level as the sampling loop reads it.
  struct Samples {
    const float* texels;
    std::ptrdiff_t stride;
    float u_scale;
    float v_scale;
    float last_u;  ///< just before the last texel, so that its right and lower neighbours exist
    float last_v;
  };

  std::array<Samples, kTextureLevels> levels;
  LinearFunction u;  ///< texel of the finest level times w
  LinearFunction v;
  LinearFunction w;  ///< inverse depth [1/m]
  float area;        ///< of a pixel at inverse depth 1, in levels' finest texels per side, squared
  std::array<LinearFunction, 4> edges;  ///< distance into the face from each side [edge widths]
};

/// One row of the image while a body is drawn into it.
struct BodyRow {
  explicit BodyRow(std::size_t width)
      : light(width), cover(width), u(width), v(width), level(width), inside(width) {}
  std::vector<float> light;  ///< of the body's faces, by their cover
  std::vector<float> cover;  ///< part of the pixel that the body fills
  int begin = 0;             ///< pixels that were touched
  int end = 0;
  // Scratch of one face.
  std::vector<float> u;
  std::vector<float> v;
  std::vector<float> level;
  std::vector<float> inside;
};

class FaceRenderer {
 public:
  /// \param texel_m between texels of the finest levels
  FaceRenderer(const PinholeCamera& camera, double texel_m, double edge_width_px)
      : camera_(camera), texel_m_(texel_m), edge_width_px_(edge_width_px) {}

  /// The faces of a body that a pose sees. \pre the body outlives them
  std::vector<FaceView> viewsOf(const TexturedBody& body, const RigidPose& pose) const;

  /// Adds light and cover of a face to row \p y of the image.
  /// \pre \p row has the camera's width
  void drawRow(const FaceView& view, int y, BodyRow& row) const;

 private:
  PinholeCamera camera_;
  double texel_m_;
  double edge_width_px_;
};

}  // namespace fast_edi
