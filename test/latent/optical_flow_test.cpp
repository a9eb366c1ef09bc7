#include "fast_edi/latent/optical_flow.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <vector>

#include <gtest/gtest.h>

#include "latent/slow_flow.hpp"

namespace fast_edi {
namespace {

constexpr SensorSize kSize{120, 90};
/// Nearer to the border less of the motion shows.
constexpr int kBorder_px = 15;

/// A texture of waves that never repeats within the image.
float waves(double x, double y) {
  return static_cast<float>(120.0 + 40.0 * std::sin(0.31 * x + 0.17 * y) +
                            30.0 * std::sin(0.12 * x - 0.27 * y + 1.0) +
                            25.0 * std::sin(0.05 * x + 0.06 * y + 2.0));
}

/// Has coarse structure, too: waves alone look alike after a period of 20 px.
float hills(double x, double y) {
  return 0.4F * waves(x, y) + static_cast<float>(45.0 * std::sin(0.07 * x + 0.02 * y) +
                                                 45.0 * std::sin(0.06 * y - 0.03 * x + 1.0));
}

using Texture = std::function<float(double x, double y)>;
/// Where a point of the image comes from.
using Mapping = std::function<Displacement(int x, int y)>;

std::vector<float> render(SensorSize size, const Texture& texture, const Mapping& displacement) {
  std::vector<float> plane;
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const Displacement u = displacement(x, y);
      plane.push_back(texture(static_cast<double>(x) + static_cast<double>(u.x),
                              static_cast<double>(y) + static_cast<double>(u.y)));
    }
  }
  return plane;
}

const Mapping kStill = [](int, int) { return Displacement{}; };

/// Largest error of the flow away from the border [px].
double largestError(const std::vector<Displacement>& flow, const Mapping& truth) {
  double largest = 0.0;
  for (int y = kBorder_px; y < kSize.height - kBorder_px; ++y) {
    for (int x = kBorder_px; x < kSize.width - kBorder_px; ++x) {
      const Displacement u =
          flow[static_cast<std::size_t>(y) * kSize.width + static_cast<std::size_t>(x)];
      const Displacement expected = truth(x, y);
      largest = std::max(largest, std::hypot(static_cast<double>(u.x - expected.x),
                                             static_cast<double>(u.y - expected.y)));
    }
  }
  return largest;
}

std::vector<Displacement> flowOf(const Texture& texture, const Mapping& truth) {
  OpticalFlow flow(kSize);
  flow.setTarget(render(kSize, texture, kStill).data());
  return flow.from(render(kSize, texture, truth).data());
}

TEST(OpticalFlow, FindsTranslationsOfFractionsOfAPixel) {
  for (const Displacement u : {Displacement{0.3F, 0.0F}, {-0.2F, 0.4F}, {1.7F, -0.9F}}) {
    const Mapping truth = [u](int, int) { return u; };
    EXPECT_LT(largestError(flowOf(waves, truth), truth), 0.1) << u.x << ", " << u.y;
  }
}

TEST(OpticalFlow, FindsLargeTranslations) {
  for (const Displacement u : {Displacement{6.5F, 0.0F}, {-4.0F, 7.0F}, {0.0F, -9.0F}}) {
    const Mapping truth = [u](int, int) { return u; };
    EXPECT_LT(largestError(flowOf(hills, truth), truth), 0.3) << u.x << ", " << u.y;
  }
}

TEST(OpticalFlow, FindsRotationAndZoom) {
  const Mapping truth = [](int x, int y) {
    const auto dx = static_cast<float>(x - kSize.width / 2);
    const auto dy = static_cast<float>(y - kSize.height / 2);
    return Displacement{0.01F * dx - 0.02F * dy, 0.02F * dx + 0.01F * dy};
  };
  EXPECT_LT(largestError(flowOf(waves, truth), truth), 0.1);
}

/// Rows or columns in the opposite order.
template <typename Element>
std::vector<Element> mirrored(const std::vector<Element>& plane, SensorSize size, bool rows) {
  std::vector<Element> result;
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const int from_x = rows ? x : size.width - 1 - x;
      const int from_y = rows ? size.height - 1 - y : y;
      result.push_back(
          plane[static_cast<std::size_t>(from_y) * size.width + static_cast<std::size_t>(from_x)]);
    }
  }
  return result;
}

/// All four borders are treated alike.
TEST(OpticalFlow, OfMirroredImagesIsMirroredUpToTheBorder) {
  constexpr SensorSize kEven{128, 64};  // on all levels of the pyramid
  constexpr float kRounding_px = 1e-4F;
  const std::vector<float> target = render(kEven, waves, kStill);
  const std::vector<float> from = render(kEven, waves, [&](int x, int y) {
    return Displacement{0.02F * static_cast<float>(x - kEven.width / 2),
                        0.02F * static_cast<float>(y - kEven.height / 2)};
  });
  OpticalFlow flow(kEven);
  flow.setTarget(target.data());
  const std::vector<Displacement> found = flow.from(from.data());
  for (const bool rows : {true, false}) {
    flow.setTarget(mirrored(target, kEven, rows).data());
    const std::vector<Displacement> back =
        mirrored(flow.from(mirrored(from, kEven, rows).data()), kEven, rows);
    for (std::size_t i = 0; i < found.size(); ++i) {
      ASSERT_NEAR(back[i].x, rows ? found[i].x : -found[i].x, kRounding_px) << rows << ", " << i;
      ASSERT_NEAR(back[i].y, rows ? -found[i].y : found[i].y, kRounding_px) << rows << ", " << i;
    }
  }
}

/// From the smallest of one level to one of all four, and one that would have a fifth, of odd and
/// even sides, with displacements that leave the image at all borders.
TEST(OpticalFlow, IsTheOneOfASlowReference) {
  for (const SensorSize size : {SensorSize{20, 24},
                                {31, 30},
                                {31, 32},
                                {32, 31},
                                {63, 62},
                                {64, 65},
                                {127, 125},
                                {128, 131},
                                {250, 243}}) {
    const Mapping turning = [size](int x, int y) {
      const auto dx = static_cast<float>(x) - 0.4F * static_cast<float>(size.width);
      const auto dy = static_cast<float>(y) - 0.6F * static_cast<float>(size.height);
      return Displacement{0.7F + 0.04F * dx - 0.03F * dy, -0.4F + 0.02F * dx + 0.05F * dy};
    };
    const std::vector<float> to = render(size, waves, kStill);
    const std::vector<float> from = render(size, waves, turning);
    OpticalFlow flow(size);
    flow.setTarget(to.data());
    const std::vector<Displacement>& found = flow.from(from.data());
    const testing::SlowFlow::Flow expected = testing::SlowFlow::flow(size, from, to);
    ASSERT_EQ(found.size(), expected.values.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
      ASSERT_NEAR(static_cast<double>(found[i].x), expected.values[i].x, 1e-3)
          << i << " of " << size.width << " x " << size.height;
      ASSERT_NEAR(static_cast<double>(found[i].y), expected.values[i].y, 1e-3)
          << i << " of " << size.width << " x " << size.height;
    }
  }
}

TEST(OpticalFlow, IsZeroBetweenEqualImages) {
  for (const Displacement& u : flowOf(waves, kStill)) {
    ASSERT_EQ(u.x, 0.0F);
    ASSERT_EQ(u.y, 0.0F);
  }
}

TEST(OpticalFlow, IsZeroWithoutTexture) {
  const std::vector<Displacement> flow = flowOf([](double, double) { return 80.0F; },
                                                [](int, int) {
                                                  return Displacement{3.0F, 3.0F};
                                                });
  for (const Displacement& u : flow) {
    ASSERT_EQ(u.x, 0.0F);
    ASSERT_EQ(u.y, 0.0F);
  }
}

TEST(OpticalFlow, SpreadsFromTextureToItsNeighbourhood) {
  // A bare strip, 8 px wide, in the middle of a texture.
  const auto strip = [](double x, double y) {
    return std::abs(x - 60.0) < 4.0 ? 100.0F : waves(x, y);
  };
  const Mapping truth = [](int, int) { return Displacement{0.0F, 0.8F}; };
  EXPECT_LT(largestError(flowOf(strip, truth), truth), 0.15);
}

TEST(OpticalFlow, TakesAnotherTarget) {
  const Mapping first = [](int, int) { return Displacement{1.0F, 0.0F}; };
  const Mapping second = [](int, int) { return Displacement{0.0F, 1.0F}; };
  OpticalFlow flow(kSize);
  const std::vector<float> still = render(kSize, waves, kStill);
  flow.setTarget(render(kSize, waves, first).data());
  flow.from(still.data());
  flow.setTarget(render(kSize, waves, second).data());
  const Mapping truth = [](int, int) { return Displacement{0.0F, -1.0F}; };
  EXPECT_LT(largestError(flow.from(still.data()), truth), 0.05);
}

TEST(OpticalFlow, TakesImagesOfAnySize) {
  for (const SensorSize size : {SensorSize{1, 1}, {1, 40}, {7, 3}, {17, 16}, {33, 65}}) {
    OpticalFlow flow(size);
    const Mapping moved = [](int, int) { return Displacement{0.5F, -0.5F}; };
    flow.setTarget(render(size, waves, kStill).data());
    const auto& found = flow.from(render(size, waves, moved).data());
    ASSERT_EQ(found.size(), size.pixelCount());
    for (const Displacement& u : found) {
      ASSERT_LT(std::abs(u.x), 4.0F) << size.width << " x " << size.height;
      ASSERT_LT(std::abs(u.y), 4.0F) << size.width << " x " << size.height;
    }
    EXPECT_GT(flow.memoryBytes(), size.pixelCount() * sizeof(Displacement));
  }
}

TEST(OpticalFlow, StaysFiniteWithTheStrongestTexture) {
  const auto checks = [](double x, double y) {
    return (static_cast<int>(std::floor(x)) + static_cast<int>(std::floor(y))) % 2 == 0 ? 0.0F
                                                                                        : 255.0F;
  };
  for (const Displacement& u : flowOf(checks, [](int, int) { return Displacement{1.0F, 0.0F}; })) {
    ASSERT_TRUE(std::isfinite(u.x) && std::isfinite(u.y));
  }
}

}  // namespace
}  // namespace fast_edi
