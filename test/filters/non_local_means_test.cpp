#include "fast_edi/filters/non_local_means.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <vector>

namespace fast_edi {
namespace {

constexpr SensorSize kSize{37, 23};

std::vector<float> noisePlane(float mean, float sigma, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<float> noise(mean, sigma);
  std::vector<float> plane(kSize.pixelCount());
  std::generate(plane.begin(), plane.end(), [&] { return noise(random); });
  return plane;
}

/// The formula of the header, pixel by pixel, in double precision.
std::vector<double> slowMeans(const std::vector<float>& values, const std::vector<float>& variance,
                              const NonLocalMeans::Settings& settings) {
  const int stride = settings.stride_px;
  const auto inside = [stride](int i, int length) {
    while (i < 0) i += stride;
    while (i >= length && i >= stride) i -= stride;
    return std::min(i, length - 1);
  };
  const auto at = [&](const std::vector<float>& plane, int x, int y) {
    return static_cast<double>(plane[static_cast<std::size_t>(
        inside(y, kSize.height) * kSize.width + inside(x, kSize.width))]);
  };
  std::vector<double> means;
  for (int y = 0; y < kSize.height; ++y) {
    for (int x = 0; x < kSize.width; ++x) {
      double sum = 0.0;
      double weights = 0.0;
      for (int j = -settings.window_radius; j <= settings.window_radius; ++j) {
        for (int i = -settings.window_radius; i <= settings.window_radius; ++i) {
          const int qx = x + i * stride;
          const int qy = y + j * stride;
          double r = 0.0;
          for (int v = -1; v <= 1; ++v) {
            for (int u = -1; u <= 1; ++u) {
              r += std::pow(at(values, x + u * stride, y + v * stride) -
                                at(values, qx + u * stride, qy + v * stride),
                            2);
            }
          }
          r *= (1.0 / at(variance, x, y) + 1.0 / at(variance, qx, qy)) / 36.0;
          const double sigma = static_cast<double>(settings.spatial_sigma);
          const double w = std::exp(-(i * i + j * j) / (2.0 * sigma * sigma)) *
                           std::pow(std::max(0.0, 1.0 - std::max(0.0, r - 1.0) / 4.0), 4);
          sum += w * (at(values, qx, qy) - at(values, x, y));
          weights += w;
        }
      }
      means.push_back(at(values, x, y) + sum / weights);
    }
  }
  return means;
}

TEST(NonLocalMeans, IsTheFormulaOfTheHeader) {
  const std::vector<float> values = noisePlane(2.0F, 0.1F, 1);
  std::vector<float> variance(kSize.pixelCount());
  for (std::size_t i = 0; i < variance.size(); ++i) {
    variance[i] = 0.004F + 0.001F * static_cast<float>(i % 13);
  }
  for (const int radius : {1, 2, 3, 4}) {
    for (const int stride : {1, 2}) {
      const NonLocalMeans::Settings settings{radius, 1.2F, stride};
      NonLocalMeans filter(kSize, settings);
      std::vector<float> out(values.size());
      filter.apply(values.data(), variance.data(), out.data());
      const std::vector<double> expected = slowMeans(values, variance, settings);
      for (std::size_t i = 0; i < out.size(); ++i) {
        ASSERT_NEAR(static_cast<double>(out[i]), expected[i], 1e-5)
            << "pixel " << i << ", radius " << radius << ", stride " << stride;
      }
    }
  }
}

TEST(NonLocalMeans, LeavesAPlaneOfOneValueExactlyAsItIs) {
  NonLocalMeans filter(kSize, {});
  const std::vector<float> values(kSize.pixelCount(), 0.1F);
  const std::vector<float> variance(kSize.pixelCount(), 0.01F);
  std::vector<float> out(values);
  filter.apply(out.data(), variance.data(), out.data());
  EXPECT_EQ(out, values);
}

TEST(NonLocalMeans, LowersNoiseAndKeepsACorner) {
  std::vector<float> values = noisePlane(0.0F, 0.05F, 2);
  const auto index = [](int x, int y) { return static_cast<std::size_t>(y * kSize.width + x); };
  for (int y = 12; y < kSize.height; ++y) {
    for (int x = 18; x < kSize.width; ++x) {
      values[index(x, y)] += 1.0F;
    }
  }
  const std::vector<float> variance(kSize.pixelCount(), 0.05F * 0.05F);
  std::vector<float> out(values.size());
  NonLocalMeans filter(kSize, {});
  filter.apply(values.data(), variance.data(), out.data());
  double before = 0.0;
  double after = 0.0;
  for (int y = 0; y < 10; ++y) {
    for (int x = 0; x < kSize.width; ++x) {
      before += std::pow(static_cast<double>(values[index(x, y)]), 2);
      after += std::pow(static_cast<double>(out[index(x, y)]), 2);
    }
  }
  EXPECT_LT(after, 0.3 * before);
  EXPECT_NEAR(out[index(18, 12)], 1.0F, 0.15F);
  EXPECT_NEAR(out[index(17, 11)], 0.0F, 0.15F);
}

TEST(NonLocalMeans, StaysFiniteWhateverTheValues) {
  std::vector<float> values = noisePlane(0.0F, 40.0F, 3);
  values[100] = 69.0F;
  values[101] = -69.0F;
  for (const float variance : {1e-8F, 1.0F, 1e8F}) {
    const std::vector<float> variances(kSize.pixelCount(), variance);
    std::vector<float> out(values.size());
    NonLocalMeans(kSize, {}).apply(values.data(), variances.data(), out.data());
    for (const float value : out) {
      ASSERT_TRUE(std::isfinite(value)) << variance;
    }
  }
}

TEST(NonLocalMeans, TakesPlanesOfAnySize) {
  for (const SensorSize size : {SensorSize{1, 1}, SensorSize{1, 9}, SensorSize{2, 2}}) {
    for (const int stride : {1, 2}) {
      std::vector<float> values(size.pixelCount(), 3.0F);
      const std::vector<float> variance(size.pixelCount(), 1.0F);
      NonLocalMeans(size, {2, 1.0F, stride}).apply(values.data(), variance.data(), values.data());
      EXPECT_EQ(values, std::vector<float>(size.pixelCount(), 3.0F));
    }
  }
}

TEST(NonLocalMeans, RefusesSettingsOutOfRange) {
  EXPECT_THROW(NonLocalMeans(kSize, {0, 1.0F, 1}), std::invalid_argument);
  EXPECT_THROW(NonLocalMeans(kSize, {NonLocalMeans::kMaxWindowRadius + 1, 1.0F, 1}),
               std::invalid_argument);
  EXPECT_THROW(NonLocalMeans(kSize, {2, 0.0F, 1}), std::invalid_argument);
  EXPECT_THROW(NonLocalMeans(kSize, {2, std::numeric_limits<float>::quiet_NaN(), 1}),
               std::invalid_argument);
  EXPECT_THROW(NonLocalMeans(kSize, {2, 1.0F, 3}), std::invalid_argument);
}

}  // namespace
}  // namespace fast_edi
