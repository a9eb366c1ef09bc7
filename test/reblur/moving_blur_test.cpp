#include "reblur/moving_blur.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace fast_edi {
namespace {

constexpr SensorSize kSize{53, 40};  // not of whole blocks

ImageMotion turning() {
  ImageMotion motion(kSize);
  motion.velocity = {3.3F, -1.7F, 0.4F, 0.8F, 0.3F, -0.2F};
  motion.curvature = {-0.6F, 0.9F, 0.0F, -0.1F, 0.0F, 0.1F};
  return motion;
}

MovingBlur blurOf(const ImageMotion& motion, std::size_t instants) {
  MovingBlur blur;
  blur.set(motion, SceneLayout(kSize, 7.0F), instants);
  return blur;
}

std::vector<float> noise(std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> level(0.0F, 255.0F);
  std::vector<float> plane(count);
  for (float& value : plane) value = level(random);
  return plane;
}

double dot(const std::vector<float>& a, const std::vector<float>& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    sum += static_cast<double>(a[i]) * static_cast<double>(b[i]);
  }
  return sum;
}

TEST(MovingBlurTest, WithoutMotionTheImageIsTheScene) {
  MovingBlur blur = blurOf(ImageMotion(kSize), 5);
  const SceneLayout& layout = blur.layout();
  const std::vector<float> scene = noise(layout.sceneFloats(), 1);
  std::vector<float> image(layout.imageFloats());
  blur.apply(scene.data(), image.data());
  for (std::size_t y = 0; y < layout.rows(); ++y) {
    for (std::size_t x = 0; x < static_cast<std::size_t>(kSize.width); ++x) {
      ASSERT_FLOAT_EQ(image[y * layout.stride() + x], scene[layout.inScene(x, y)]);
    }
  }
}

/// The header's sum, pixel by pixel in double precision.
TEST(MovingBlurTest, IsTheMeanOfTheSharpenedSceneAlongThePath) {
  constexpr std::size_t kInstants = 6;
  const ImageMotion motion = turning();
  MovingBlur blur = blurOf(motion, kInstants);
  const SceneLayout& layout = blur.layout();
  const std::vector<float> scene = noise(layout.sceneFloats(), 6);
  std::vector<float> image(layout.imageFloats());
  blur.apply(scene.data(), image.data());

  const auto width = static_cast<int>(layout.sceneStride());
  const auto margin = static_cast<int>(layout.margin());
  /// Of 8 x 4 pixels.
  const auto way = [&](int x, int y, std::size_t k) {
    const float tau = static_cast<float>(2 * k + 1) / static_cast<float>(kInstants) - 1.0F;
    return motion.displacement(static_cast<float>(x / 8 * 8) + 3.5F,
                               static_cast<float>(y / 4 * 4) + 1.5F, tau);
  };
  double lost_x = 0.0;
  double lost_y = 0.0;
  int taps = 0;
  for (int y = 0; y < static_cast<int>(layout.rows()); y += 4) {
    for (int x = 0; x < static_cast<int>(layout.stride()); x += 8) {
      for (std::size_t k = 0; k < kInstants; ++k, ++taps) {
        const Displacement u = way(x, y, k);
        const double fx = static_cast<double>(u.x - std::floor(u.x));
        const double fy = static_cast<double>(u.y - std::floor(u.y));
        lost_x += fx * (1.0 - fx) / 2.0;
        lost_y += fy * (1.0 - fy) / 2.0;
      }
    }
  }
  lost_x /= taps;
  lost_y /= taps;
  const auto sharp = [&](int x, int y) {
    const auto at = [&](int u, int v) {
      return static_cast<double>(scene[static_cast<std::size_t>(v * width + u)]);
    };
    return at(x, y) - lost_x * (at(x - 1, y) - 2.0 * at(x, y) + at(x + 1, y)) -
           lost_y * (at(x, y - 1) - 2.0 * at(x, y) + at(x, y + 1));
  };
  for (int y = 0; y < static_cast<int>(layout.rows()); ++y) {
    for (int x = 0; x < kSize.width; ++x) {
      double sum = 0.0;
      for (std::size_t k = 0; k < kInstants; ++k) {
        const Displacement u = way(x, y, k);
        const double to_x = margin + x + static_cast<double>(u.x);
        const double to_y = margin + y + static_cast<double>(u.y);
        const int left = static_cast<int>(to_x);
        const int top = static_cast<int>(to_y);
        const double fx = to_x - left;
        const double fy = to_y - top;
        sum += (1.0 - fy) * ((1.0 - fx) * sharp(left, top) + fx * sharp(left + 1, top)) +
               fy * ((1.0 - fx) * sharp(left, top + 1) + fx * sharp(left + 1, top + 1));
      }
      ASSERT_NEAR(
          static_cast<double>(
              image[static_cast<std::size_t>(y) * layout.stride() + static_cast<std::size_t>(x)]),
          sum / static_cast<double>(kInstants), 1e-3)
          << x << ", " << y;
    }
  }
}

TEST(MovingBlurTest, TheTransposedOperatorIsTheTransposedOne) {
  MovingBlur blur = blurOf(turning(), 6);
  const SceneLayout& layout = blur.layout();
  std::vector<float> scene = noise(layout.sceneFloats(), 2);
  // No tap reaches the first and last row.
  std::fill_n(scene.begin(), layout.sceneStride(), 0.0F);
  std::fill_n(scene.end() - static_cast<std::ptrdiff_t>(layout.sceneStride()), layout.sceneStride(),
              0.0F);
  std::vector<float> image = noise(layout.imageFloats(), 3);
  std::vector<float> blurred(layout.imageFloats());
  std::vector<float> spread(layout.sceneFloats());
  blur.apply(scene.data(), blurred.data());
  blur.applyTransposed(image.data(), spread.data());
  const double expected = dot(blurred, image);
  EXPECT_NEAR(dot(scene, spread), expected, 1e-5 * expected);
}

/// Column by column: what each pixel of some spreads is what it gathers.
TEST(MovingBlurTest, EachPixelSpreadsWhatItGathers) {
  MovingBlur blur = blurOf(turning(), 3);
  const SceneLayout& layout = blur.layout();
  for (const std::size_t pixel :
       {std::size_t{0}, std::size_t{15}, std::size_t{52}, 17 * layout.stride() + 24,
        39 * layout.stride(), 39 * layout.stride() + 52}) {
    std::vector<float> image(layout.imageFloats());
    image[pixel] = 1.0F;
    std::vector<float> spread(layout.sceneFloats());
    blur.applyTransposed(image.data(), spread.data());
    std::vector<float> scene(layout.sceneFloats());
    double sum = 0.0;
    for (std::size_t i = 0; i < scene.size(); ++i) {
      sum += static_cast<double>(spread[i]);
      if (spread[i] == 0.0F) continue;
      scene[i] = 1.0F;
      blur.apply(scene.data(), image.data());
      scene[i] = 0.0F;
      ASSERT_NEAR(image[pixel], spread[i], 1e-6F) << pixel << ", " << i;
    }
    EXPECT_NEAR(sum, 1.0, 1e-5) << pixel;
  }
}

TEST(MovingBlurTest, TheNormalOperatorIsAWeightsAndATransposed) {
  MovingBlur blur = blurOf(turning(), 5);
  const SceneLayout& layout = blur.layout();
  const std::vector<float> scene = noise(layout.sceneFloats(), 4);
  std::vector<float> weights = noise(layout.imageFloats(), 5);
  std::vector<float> image(layout.imageFloats());
  blur.apply(scene.data(), image.data());
  for (std::size_t i = 0; i < image.size(); ++i) {
    if (i % layout.stride() >= static_cast<std::size_t>(kSize.width)) weights[i] = 0.0F;
    image[i] *= weights[i];
  }
  std::vector<float> expected(layout.sceneFloats());
  blur.applyTransposed(image.data(), expected.data());
  std::vector<float> product(layout.sceneFloats());
  std::size_t prepared = 0;
  std::size_t changed = 0;
  std::size_t finished = 0;
  std::vector<float> known(layout.sceneFloats(), std::numeric_limits<float>::quiet_NaN());
  blur.applyNormalRows(
      known.data(), product.data(),
      [&](std::size_t row) {
        EXPECT_EQ(row, prepared++);
        const std::size_t first = row * layout.sceneStride();
        std::copy_n(scene.data() + first, layout.sceneStride(), known.data() + first);
      },
      [&](std::size_t row, float* values) {
        EXPECT_EQ(row, changed++);
        for (std::size_t x = 0; x < layout.stride(); ++x) {
          values[x] *= weights[row * layout.stride() + x];
        }
      },
      [&](std::size_t row) {
        EXPECT_EQ(row, finished++);
        const std::size_t first = row * layout.sceneStride();
        for (std::size_t i = first; i < first + layout.sceneStride(); ++i) {
          ASSERT_EQ(product[i], expected[i]) << row;  // it will not change any more
        }
      });
  EXPECT_EQ(prepared, layout.sceneRows());
  EXPECT_EQ(changed, layout.rows());
  EXPECT_EQ(finished, layout.sceneRows());
  EXPECT_EQ(product, expected);
}

// cos(k x) moved by u and averaged over the path is known in closed form.
TEST(MovingBlurTest, AWaveIsDampedAsOverItsPath) {
  constexpr double kWave = 0.7;  // rad/px
  ImageMotion motion(kSize);
  motion.velocity = {2.9F, 0.0F, 0.0F, 0.0F, 0.0F, 0.0F};
  MovingBlur blur = blurOf(motion, 11);
  const SceneLayout& layout = blur.layout();
  std::vector<float> scene(layout.sceneFloats());
  for (std::size_t y = 0; y < layout.sceneRows(); ++y) {
    for (std::size_t x = 0; x < layout.sceneStride(); ++x) {
      const double from_image = static_cast<double>(x) - static_cast<double>(layout.margin());
      scene[y * layout.sceneStride() + x] =
          static_cast<float>(100.0 + 80.0 * std::cos(kWave * from_image));
    }
  }
  std::vector<float> image(layout.imageFloats());
  blur.apply(scene.data(), image.data());
  const double half_path = kWave * 2.9;
  for (std::size_t x = 0; x < static_cast<std::size_t>(kSize.width); ++x) {
    const double expected =
        100.0 + 80.0 * std::sin(half_path) / half_path * std::cos(kWave * static_cast<double>(x));
    ASSERT_NEAR(static_cast<double>(image[layout.stride() + x]), expected, 0.8) << x;
  }
}

TEST(SceneLayoutTest, DisplacementsBeyondTheMarginAreCutOff) {
  const SceneLayout layout(kSize, 7.0F);
  for (const float far : {-1e6F, 1e6F}) {
    const SceneLayout::Tap tap = layout.tap(0, 0, {far, far});
    EXPECT_GE(tap.offset, 0);
    const SceneLayout::Tap last = layout.tap(layout.blocks() - 1, layout.rows() - 1, {far, far});
    EXPECT_LT(static_cast<std::size_t>(last.offset) + layout.sceneStride() + kFloatBlock,
              layout.sceneFloats());
  }
}

}  // namespace
}  // namespace fast_edi
