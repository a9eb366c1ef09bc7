#include "fast_edi/core/edge_preserving_filter.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>
#include <vector>

namespace fast_edi {
namespace {

constexpr SensorSize kSize{37, 23};

std::vector<float> noisePlane(float mean, float sigma) {
  std::mt19937 random(7);
  std::normal_distribution<float> normal(mean, sigma);
  std::vector<float> plane(kSize.pixelCount());
  for (float& value : plane) {
    value = normal(random);
  }
  return plane;
}

double standardDeviation(const std::vector<float>& plane) {
  double sum = 0.0;
  double squares = 0.0;
  for (const float value : plane) {
    sum += value;
    squares += static_cast<double>(value) * value;
  }
  const double n = static_cast<double>(plane.size());
  return std::sqrt(squares / n - (sum / n) * (sum / n));
}

/// The header's formula, word for word, in double.
double slowFilter(const std::vector<float>& plane, SensorSize size,
                  const EdgePreservingFilter::Settings& settings, int x, int y) {
  const auto at = [&](int px, int py) {
    const auto inside = [&](int i, int length) {
      while (i < 0) i += settings.stride_px;
      while (i >= length) i -= settings.stride_px;
      return i;
    };
    return static_cast<double>(plane[static_cast<std::size_t>(inside(py, size.height) * size.width +
                                                              inside(px, size.width))]);
  };
  const double centre = at(x, y);
  double sum = 0.0;
  double weights = 0.0;
  for (int dy = -2; dy <= 2; ++dy) {
    for (int dx = -2; dx <= 2; ++dx) {
      const double q = at(x + dx * settings.stride_px, y + dy * settings.stride_px);
      const double d = q - centre;
      const double sigma = settings.range_sigma;
      const double space = settings.spatial_sigma;
      const double w = std::exp(-(dx * dx + dy * dy) / (2.0 * space * space)) *
                       std::pow(std::max(0.0, 1.0 - d * d / (8.0 * sigma * sigma)), 4);
      sum += w * q;
      weights += w;
    }
  }
  return sum / weights;
}

class EdgePreservingFilterStride : public ::testing::TestWithParam<int> {};

TEST_P(EdgePreservingFilterStride, MatchesTheFormulaEverywhereUpToTheBorder) {
  const EdgePreservingFilter::Settings settings{0.8F, 1.3F, GetParam()};
  EdgePreservingFilter filter(kSize, settings);
  const std::vector<float> plane = noisePlane(3.0F, 1.0F);
  std::vector<float> out(plane.size());
  filter.apply(plane.data(), out.data());
  for (int y = 0; y < kSize.height; ++y) {
    for (int x = 0; x < kSize.width; ++x) {
      EXPECT_NEAR(out[static_cast<std::size_t>(y * kSize.width + x)],
                  slowFilter(plane, kSize, settings, x, y), 1e-5)
          << x << ", " << y;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Strides, EdgePreservingFilterStride, ::testing::Values(1, 2));

TEST(EdgePreservingFilter, LeavesAFlatPlaneAsItIs) {
  EdgePreservingFilter filter(kSize, {0.5F, 1.5F, 1});
  const std::vector<float> plane(kSize.pixelCount(), 0.7F);
  std::vector<float> out(plane.size());
  filter.apply(plane.data(), out.data());
  EXPECT_EQ(out, plane);
}

TEST(EdgePreservingFilter, LowersNoiseWithinTheRange) {
  EdgePreservingFilter filter(kSize, {4.0F, 1.5F, 1});
  std::vector<float> plane = noisePlane(100.0F, 1.0F);
  const double before = standardDeviation(plane);
  filter.apply(plane.data(), plane.data());
  EXPECT_LT(standardDeviation(plane), 0.4 * before);
}

TEST(EdgePreservingFilter, KeepsAStepThatIsLargerThanTheRange) {
  EdgePreservingFilter filter(kSize, {0.3F, 1.5F, 1});
  std::vector<float> plane(kSize.pixelCount());
  for (std::size_t i = 0; i < plane.size(); ++i) {
    plane[i] = i % static_cast<std::size_t>(kSize.width) < 18 ? 0.0F : 1.0F;
  }
  const std::vector<float> before = plane;
  filter.apply(plane.data(), plane.data());
  EXPECT_EQ(plane, before);
}

TEST(EdgePreservingFilter, DoesNotMixTheColoursOfAMosaic) {
  EdgePreservingFilter filter(kSize, {10.0F, 1.5F, 2});
  std::vector<float> plane(kSize.pixelCount());
  for (int y = 0; y < kSize.height; ++y) {
    for (int x = 0; x < kSize.width; ++x) {
      plane[static_cast<std::size_t>(y * kSize.width + x)] =
          static_cast<float>(2 * (y % 2) + x % 2);
    }
  }
  const std::vector<float> before = plane;
  filter.apply(plane.data(), plane.data());
  EXPECT_EQ(plane, before);
}

TEST(EdgePreservingFilter, WorksOnASinglePixel) {
  EdgePreservingFilter filter({1, 1}, {1.0F, 1.0F, 1});
  float value = 5.0F;
  filter.apply(&value, &value);
  EXPECT_EQ(value, 5.0F);
}

TEST(EdgePreservingFilter, RefusesSettingsOutOfRange) {
  EXPECT_THROW(EdgePreservingFilter(kSize, {0.0F, 1.0F, 1}), std::invalid_argument);
  EXPECT_THROW(EdgePreservingFilter(kSize, {1.0F, -1.0F, 1}), std::invalid_argument);
  EXPECT_THROW(EdgePreservingFilter(kSize, {1.0F, 1.0F, 3}), std::invalid_argument);
}

}  // namespace
}  // namespace fast_edi
