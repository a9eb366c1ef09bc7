/// \file
/// Moves the latent image towards what the blurry frame says beyond the events.
///
/// With A the blur of the known motion (MovingBlur), B the blurry frame and L0 the latent image
/// that the events give, the solution L0 + d minimises
///
///     sum_x m(x) (B - A (L0 + d))^2 + sum_x a(x) d^2 + sum_pq w_pq (d_p - d_q)^2
///
/// - m = 1 / (sigma^2 (1 + (r / (6 sigma))^2)), r the residual B - A L0 and sigma the noise of the
///   frame, at least 1 DN: residuals that noise does not explain count less. Saturated pixels do
///   not count.
/// - a = 1 / s^2, s = 2 DN + 0.1 min(1, n') L0 with n' the mean events: pixels with events must be
///   free to move, or two thirds of the gain are lost.
/// - w = 0.2 / (1 + (D / (3 DN))^2) for neighbours that differ by D in L0: corrections are alike
///   within a surface.
///
/// Four steps of conjugate gradients from d = 0: more follow the noise.
#pragma once

#include <cstddef>
#include <vector>

#include "reblur/moving_blur.hpp"

namespace fast_edi {

class ResidualSolver {
 public:
  /// Planes of the image, row-major.
  struct Input {
    const float* blurry_dn = nullptr;    ///< B [8-bit DN]
    const float* latent_dn = nullptr;    ///< L0 [8-bit DN]
    const float* mean_counts = nullptr;  ///< n'
    float noise_dn = 0.0F;               ///< sigma
    float offset_dn = 0.0F;  ///< of the camera response; s grows with the light, L0 and this
  };

  void solve(const Input& input, MovingBlur& blur);

  // As planes of the blur's layout:

  const std::vector<float>& given() const { return given_; }        ///< L0 [8-bit DN]
  const std::vector<float>& solution() const { return solution_; }  ///< L0 + d [8-bit DN]
  /// B - A L0 and B - A (L0 + d) [8-bit DN]; 0 beyond the image and where it is saturated.
  const std::vector<float>& residualBefore() const { return before_; }
  const std::vector<float>& residualAfter() const { return after_; }

  std::size_t memoryBytes() const;

 private:
  void load(const Input& input, const SceneLayout& layout);
  void measureResidual(const Input& input, MovingBlur& blur, const std::vector<float>& scene,
                       std::vector<float>& residual);
  double applyEquations(MovingBlur& blur);
  void iterate(MovingBlur& blur);

  std::vector<float> given_;
  std::vector<float> solution_;
  std::vector<float> anchor_;     ///< a
  std::vector<float> across_;     ///< w of a pixel and the next one of its row
  std::vector<float> down_;       ///< w of a pixel and the one below it
  std::vector<float> precision_;  ///< m
  std::vector<float> before_;
  std::vector<float> after_;
  std::vector<float> image_;
  // Of the conjugate gradients:
  std::vector<float> direction_;
  std::vector<float> gradient_;
  std::vector<float> product_;
};

}  // namespace fast_edi
