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
/// Four steps of conjugate gradients from d = 0: more follow the noise. Each step is one pass over
/// the rows: what the step before changes is changed as the rows are come to. So the new squares
/// |g'|^2 of the gradient are needed before there is a g'; with the direction p, the step's length
/// a and q = N p they are a^2 |q|^2 - |g|^2 (Chronopoulos and Gear, J. Comput. Appl. Math. 1989).
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
  /// A step of conjugate gradients, taken as the next pass comes to the rows.
  struct Step {
    float length = 0.0F;  ///< along the direction
    float factor = 0.0F;  ///< of the old direction in the new one
  };

  void resize(const SceneLayout& layout);
  void loadRow(const Input& input, const SceneLayout& layout, std::size_t row);
  void weighRow(const Input& input, const SceneLayout& layout, std::size_t row, float* values);
  double start(const Input& input, MovingBlur& blur);
  void advanceRow(const SceneLayout& layout, std::size_t row, const Step& step);
  double addPriorOfRow(const SceneLayout& layout, std::size_t row, double* squares);
  bool next(MovingBlur& blur, double& squares, Step& step);
  double lastEnergy(MovingBlur& blur, const Step& step);
  void finish(const Input& input, MovingBlur& blur, float length);

  std::vector<float> given_;
  std::vector<float> solution_;
  std::vector<float> anchor_;     ///< a
  std::vector<float> across_;     ///< w of a pixel and the next one of its row
  std::vector<float> down_;       ///< w of a pixel and the one below it
  std::vector<float> precision_;  ///< m
  std::vector<float> before_;
  std::vector<float> after_;
  // Of the conjugate gradients:
  std::vector<float> direction_;
  std::vector<float> gradient_;
  std::vector<float> product_;
};

}  // namespace fast_edi
