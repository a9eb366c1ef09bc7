/// \file
/// The simulated plane and its rendering.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <opencv2/core.hpp>

#include "scenes/april_tags.hpp"
#include "scenes/simulation_settings.hpp"

namespace fast_edi {

/// A textured plane. Kept at kTexelsPerPixel samples per nominal pixel, already blurred by lens and
/// photodiode area, so that bilinear sampling at one point per pixel does not alias as long as the
/// zoom stays near 1. Beyond its border the plane keeps the border's values.
class Scene {
 public:
  static constexpr int kTexelsPerPixel = 2;
  /// Plane beyond the nominal view on each side [px]; more than any motion of scale 1 reaches.
  static constexpr int kMarginPx = 180;

  /// \throws std::runtime_error when the texture file cannot be read, std::invalid_argument when
  ///         the tags do not fit
  Scene(const SceneSettings& settings, SensorSize view, ColourFilter filter, std::uint64_t seed);

  /// Irradiance of every pixel, 1 = a white surface at illumination 1.
  /// \param image_to_plane homography from pixel to plane coordinates
  /// \param t_ns for flicker alone
  /// \param irradiance CV_32FC1, allocated when needed
  void render(const cv::Matx33d& image_to_plane, std::int64_t t_ns, cv::Mat1f& irradiance) const;

  /// Modulation of the light at an instant, 1 in the mean.
  double lightAt(std::int64_t t_ns) const;

  const std::vector<PlacedTag>& tags() const { return tags_; }

 private:
  void drawLamps(std::uint64_t seed, cv::Mat3f& texels) const;

  SceneSettings settings_;
  SensorSize view_;
  std::vector<PlacedTag> tags_;
  std::array<cv::Mat1f, 3> planes_;                 ///< R, G, B, or the first alone: luminance
  std::array<std::array<int, 2>, 2> photosites_{};  ///< plane seen by pixel (y & 1, x & 1)
};

}  // namespace fast_edi
