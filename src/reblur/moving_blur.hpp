/// \file
/// The blur that a known motion causes, as a linear operator on the scene, and its transpose.
///
///     (A L)(x) = 1/K sum_k (S L)(x + u(x, tau_k)),     tau_k = (2 k + 1) / K - 1
///
/// Levels between pixels are interpolated linearly, which blurs by itself: at a fraction f of the
/// way to the next pixel, the frequency w is damped by about f (1 - f) w^2 / 2. S makes good for
/// the mean of that over the taps: a Laplacian weighed with it. Without S the operator is blurrier
/// than the light was, and what it is inverted for is too sharp (-2 dB where the image moves by
/// 2 px).
///
/// Complexity. O(pixels * K).
#pragma once

#include <cstddef>
#include <vector>

#include "reblur/image_motion.hpp"
#include "reblur/scene_layout.hpp"

namespace fast_edi {

class MovingBlur {
 public:
  /// \param instants K, >= 1
  void set(const ImageMotion& motion, const SceneLayout& layout, std::size_t instants);

  const SceneLayout& layout() const { return layout_; }

  /// \param scene layout().sceneFloats() levels
  /// \param image layout().imageFloats(), written: A L
  void apply(const float* scene, float* image);
  /// \param image layout().imageFloats() values; those beyond the image's width must be 0
  /// \param scene layout().sceneFloats(), written: A^T times the image
  void applyTransposed(const float* image, float* scene);
  /// A^T diag(weights) A, row by row, so that no image in between is written.
  /// \param weights layout().imageFloats() values; those beyond the image's width must be 0
  void applyNormal(const float* scene, const float* weights, float* out);

  std::size_t memoryBytes() const;

 private:
  void sharpen(const float* in, float* out) const;
  void gather(std::size_t row, float* out) const;
  void scatter(std::size_t row);
  std::size_t tapsBefore(std::size_t row) const { return row * instants_ * layout_.blocks(); }

  SceneLayout layout_;
  std::size_t instants_ = 1;
  std::vector<SceneLayout::Tap> taps_;  ///< [row][instant][block]
  float lost_x_ = 0.0F;                 ///< by interpolation: mean of f (1 - f) / 2
  float lost_y_ = 0.0F;
  std::vector<float> sharpened_;
  std::vector<float> sum_;      ///< of what was scattered
  std::vector<float> row_;      ///< of the image
  std::vector<float> shifted_;  ///< the same, each block by one pixel
};

}  // namespace fast_edi
