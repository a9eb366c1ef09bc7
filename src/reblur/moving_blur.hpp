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
/// Method. Row by row, so that what a row needs of the scene, and adds to it, stays in the cache:
/// applyRows() and applyNormalRows() give and take rows in between. One displacement serves 8 x 4
/// pixels.
///
/// Complexity. O(pixels * K).
#pragma once

#include <algorithm>
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

  /// A L, row by row.
  /// \param prepare prepare(row): before a row of the scene is read, for all of them in order
  /// \param take take(row, values): each row of A L, layout().stride() values, in order
  template <typename Prepare, typename Take>
  void applyRows(const float* scene, Prepare prepare, Take take) {
    std::size_t group = 0;
    for (std::size_t prepared = 0; prepared < layout_.sceneRows(); ++prepared) {
      prepare(prepared);
      const std::size_t ready = sharpenBehind(scene, prepared);
      for (; group < layout_.groups() && lastReached(group) < ready; ++group) {
        gather(group);
        forRows(group, take);
      }
    }
  }

  /// A^T f(A L), row by row.
  /// \param prepare as above
  /// \param change change(row, values): puts f of a row of A L in its place; beyond the image's
  ///        width it must be 0
  /// \param out written: layout().sceneFloats() values
  /// \param finish finish(row): after a row of out was written, for all of them in order
  template <typename Prepare, typename Change, typename Finish>
  void applyNormalRows(const float* scene, float* out, Prepare prepare, Change change,
                       Finish finish) {
    std::size_t group = 0;
    std::size_t row = 0;
    for (std::size_t prepared = 0; prepared < layout_.sceneRows(); ++prepared) {
      prepare(prepared);
      clearSum(prepared);
      const std::size_t ready = sharpenBehind(scene, prepared);
      for (; group < layout_.groups() && lastReached(group) < ready; ++group) {
        gather(group);
        forRows(group, change);
        scatter(group);
        for (const std::size_t next = (group + 1) * kRowsAlike; row < next; ++row) {
          sharpenRow(sum_.data(), row, out);  // groups to come add nothing to it nor below it
          finish(row);
        }
      }
    }
    for (; row < layout_.sceneRows(); ++row) {
      sharpenRow(sum_.data(), row, out);
      finish(row);
    }
  }

  std::size_t memoryBytes() const;

 private:
  void sharpenRow(const float* in, std::size_t row, float* out) const;
  std::size_t sharpenBehind(const float* scene, std::size_t prepared);
  void clearSum(std::size_t row);
  void gather(std::size_t group);
  void scatter(std::size_t group);
  /// Calls use(row, values) for the rows of a group, and clears those beyond the image.
  template <typename Use>
  void forRows(std::size_t group, Use use) {
    float* values = rows_.data() + kFloatBlock;
    for (std::size_t i = 0; i < kRowsAlike; ++i, values += layout_.stride()) {
      const std::size_t row = group * kRowsAlike + i;
      if (row < layout_.rows()) {
        use(row, values);
      } else {
        std::fill_n(values, layout_.stride(), 0.0F);
      }
    }
  }
  /// Row r of the image reaches rows r + 1 to r + 2 margin() of the scene.
  std::size_t lastReached(std::size_t group) const {
    return (group + 1) * kRowsAlike - 1 + 2 * layout_.margin();
  }
  const SceneLayout::Tap* tapsOf(std::size_t group) const {
    return taps_.data() + group * instants_ * layout_.blocks();
  }

  SceneLayout layout_;
  std::size_t instants_ = 1;
  std::vector<SceneLayout::Tap> taps_;  ///< [group][instant][block]
  float lost_x_ = 0.0F;                 ///< by interpolation: mean of f (1 - f) / 2
  float lost_y_ = 0.0F;
  std::vector<float> sharpened_;
  std::vector<float> sum_;   ///< of what was scattered
  std::vector<float> rows_;  ///< of the image, those of a group, behind a block of zeros
};

}  // namespace fast_edi
