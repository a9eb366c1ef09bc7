/// \file
/// How the image moves during an exposure.
#pragma once

#include <array>
#include <cstddef>

#include "fast_edi/base/types.hpp"
#include "fast_edi/latent/optical_flow.hpp"

namespace fast_edi {

/// The latent image at another instant of the exposure is that of mid-exposure, moved:
///
///     L(x, tau) = L(x + u(x, tau), 0),     u(x, tau) = tau B(x) c1 + tau^2 B(x) c2
///
/// with tau = -1 at the exposure's start, 0 in its middle, 1 at its end: a path that may curve.
/// With (X, Y) the position from the image's centre in units of its half width,
///
///     B(x) c = (c_0 + c_2 X - c_3 Y, c_1 + c_3 X + c_2 Y) + (c_4 X + c_5 Y) (X, Y):
///
/// translation, zoom, rotation and tilt; to second order in X and Y all that a camera does that
/// turns in place, or that moves before a plane. Without tilt the corners are wrong by a tenth of
/// their way.
class ImageMotion {
 public:
  static constexpr std::size_t kParts = 6;
  using Parts = std::array<float, kParts>;  ///< c [px]

  ImageMotion() = default;
  explicit ImageMotion(SensorSize size)
      : centre_x_(kHalf * static_cast<float>(size.width - 1)),
        centre_y_(kHalf * static_cast<float>(size.height - 1)),
        scale_(1.0F / (kHalf * static_cast<float>(size.width))) {}

  /// X and Y of a pixel.
  float relativeX(float x) const { return scale_ * (x - centre_x_); }
  float relativeY(float y) const { return scale_ * (y - centre_y_); }

  /// tau c1 + tau^2 c2.
  Parts at(float tau) const {
    Parts sum{};
    for (std::size_t i = 0; i < kParts; ++i) {
      sum[i] = tau * (velocity[i] + tau * curvature[i]);
    }
    return sum;
  }
  /// B(x) c [px].
  Displacement displace(const Parts& c, float x, float y) const {
    const float right = relativeX(x);
    const float down = relativeY(y);
    const float zoom = c[2] + c[4] * right + c[5] * down;
    return {c[0] + zoom * right - c[3] * down, c[1] + c[3] * right + zoom * down};
  }
  /// u(x, tau) [px].
  Displacement displacement(float x, float y, float tau) const { return displace(at(tau), x, y); }

  Parts velocity{};   ///< c1
  Parts curvature{};  ///< c2

 private:
  static constexpr float kHalf = 0.5F;

  float centre_x_ = 0.0F;
  float centre_y_ = 0.0F;
  float scale_ = 1.0F;
};

}  // namespace fast_edi
