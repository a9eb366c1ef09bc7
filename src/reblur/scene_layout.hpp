/// \file
/// How planes of the scene and of the image lie in memory while an image is re-blurred.
///
/// During the exposure more of the scene is seen than in the middle of it. So the scene has a
/// margin on all sides, of whole blocks, as wide as the image moves, and whole groups of rows. Both
/// kinds of planes have rows
/// of whole blocks; one displacement serves a block in a few rows, so that all loads are
/// contiguous.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "fast_edi/base/types.hpp"
#include "fast_edi/latent/optical_flow.hpp"

namespace fast_edi {

/// Pixels of a block.
constexpr std::size_t kFloatBlock = 8;
/// Rows of the image that share their displacements.
constexpr std::size_t kRowsAlike = 4;
/// A block: one register or two. The compiler splits its operations as the processor needs it,
/// element by element, so that results are the same everywhere.
using FloatBlock = float __attribute__((vector_size(kFloatBlock * sizeof(float))));

class SceneLayout {
 public:
  /// Where a block of the image is found in the scene: between the four pixels from here on.
  struct Tap {
    std::int32_t offset;  ///< index of the upper left one for the block's first pixel
    float x;              ///< way to the right one, 0 to 1
    float y;              ///< way to the lower one
  };

  SceneLayout() = default;
  /// \param size of the image
  /// \param reach_px largest displacement
  SceneLayout(SensorSize size, float reach_px)
      : size_(size),
        reach_px_(reach_px),
        blocks_(inBlocks(static_cast<std::size_t>(size.width))),
        margin_(kFloatBlock * inBlocks(static_cast<std::size_t>(std::ceil(reach_px)) + kSpare)),
        limit_(static_cast<float>(margin_ - 1)) {}

  SensorSize size() const { return size_; }
  std::size_t rows() const { return static_cast<std::size_t>(size_.height); }
  std::size_t groups() const { return (rows() + kRowsAlike - 1) / kRowsAlike; }  ///< of rows alike
  std::size_t blocks() const { return blocks_; }  ///< in a row of the image
  std::size_t stride() const { return blocks_ * kFloatBlock; }
  std::size_t imageFloats() const { return stride() * rows(); }

  float reach() const { return reach_px_; }
  std::size_t margin() const { return margin_; }
  std::size_t sceneStride() const { return stride() + 2 * margin_; }
  std::size_t sceneRows() const { return groups() * kRowsAlike + 2 * margin_; }
  std::size_t sceneFloats() const { return sceneStride() * sceneRows(); }
  /// Index of a pixel of the image in the scene.
  std::size_t inScene(std::size_t x, std::size_t y) const {
    return (y + margin_) * sceneStride() + margin_ + x;
  }

  /// Largest whole number that is not larger; std::floor() is a call on processors without SSE4.1.
  static float floorOf(float value) {
    const auto whole = static_cast<float>(static_cast<std::int32_t>(value));
    return whole - (whole > value ? 1.0F : 0.0F);
  }
  /// Position of the middle of a block along its row.
  static float centreOf(std::size_t block) {
    constexpr float kMiddle = 0.5F * static_cast<float>(kFloatBlock - 1);
    return static_cast<float>(block * kFloatBlock) + kMiddle;
  }
  /// Middle of a group of rows alike.
  static float centreOfGroup(std::size_t group) {
    constexpr float kMiddle = 0.5F * static_cast<float>(kRowsAlike - 1);
    return static_cast<float>(group * kRowsAlike) + kMiddle;
  }
  /// Displacements beyond the margin are cut off.
  Tap tap(std::size_t block, std::size_t y, const Displacement& u) const {
    const float x_px = std::clamp(u.x, -limit_, limit_);
    const float y_px = std::clamp(u.y, -limit_, limit_);
    const float left = floorOf(x_px);
    const float upper = floorOf(y_px);
    const auto stride = static_cast<std::int32_t>(sceneStride());
    return {static_cast<std::int32_t>(inScene(block * kFloatBlock, y)) +
                static_cast<std::int32_t>(upper) * stride + static_cast<std::int32_t>(left),
            x_px - left, y_px - upper};
  }

 private:
  static constexpr std::size_t kSpare = 2;  ///< for the interpolation, [px]

  static std::size_t inBlocks(std::size_t count) { return (count + kFloatBlock - 1) / kFloatBlock; }

  SensorSize size_;
  float reach_px_ = 0.0F;
  std::size_t blocks_ = 0;
  std::size_t margin_ = 0;
  float limit_ = 0.0F;
};

}  // namespace fast_edi
