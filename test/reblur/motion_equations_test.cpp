#include "reblur/motion_equations.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <gtest/gtest.h>

namespace fast_edi {
namespace {

constexpr SensorSize kSize{160, 120};
constexpr double kTaus[] = {-1.0, 0.5, 1.0};

/// Residuals that are linear in the unknowns: of places all over the image, with gradients in all
/// directions, 0 for the motion and the share that are to be found.
class Linear {
 public:
  Linear(const FittedMotion& wanted, const FittedMotion& at) {
    for (const double tau : kTaus) {
      MotionEquations::Sums sums;
      for (int i = 0; i < 400; ++i) {
        const float x = 2.0F * std::fmod(0.618F * static_cast<float>(i), 1.0F) - 1.0F;
        const float y = 1.5F * std::fmod(0.377F * static_cast<float>(i), 1.0F) - 0.75F;
        const float gx = std::cos(static_cast<float>(i));
        const float gy = std::sin(static_cast<float>(i));
        const float zoom = gx * x + gy * y;
        const float change = std::sin(1.7F * static_cast<float>(i));
        const float slopes[] = {gx, gy, zoom, gy * x - gx * y, zoom * x, zoom * y, change};
        double residual = static_cast<double>(change * (at.event_share - wanted.event_share));
        for (std::size_t part = 0; part < ImageMotion::kParts; ++part) {
          const auto apart = [part](const ImageMotion::Parts& a, const ImageMotion::Parts& b) {
            return static_cast<double>(a[part] - b[part]);
          };
          residual += static_cast<double>(slopes[part]) *
                      (tau * apart(at.motion.velocity, wanted.motion.velocity) +
                       tau * tau * apart(at.motion.curvature, wanted.motion.curvature));
        }
        for (std::size_t j = 0; j < MotionEquations::kSlopes; ++j) {
          for (std::size_t k = 0; k <= j; ++k) sums.squares[j][k] += slopes[j] * slopes[k];
          sums.products[j] += slopes[j] * static_cast<float>(residual);
        }
        sums.weight += 1.0F;
        sums.residuals += 1e-6F;
      }
      equations.add(sums, tau);
    }
    equations.addPriors(at);
  }

  MotionEquations equations;
};

FittedMotion motionOf(ImageMotion::Parts velocity, ImageMotion::Parts curvature, float share) {
  FittedMotion fitted;
  fitted.motion = ImageMotion(kSize);
  fitted.motion.velocity = velocity;
  fitted.motion.curvature = curvature;
  fitted.event_share = share;
  return fitted;
}

const FittedMotion kStart = motionOf({}, {}, 1.0F);
const FittedMotion kWanted =
    motionOf({3.0F, -2.0F, 0.5F, 1.0F, 0.2F, -0.1F}, {0.5F, 0.3F, -0.2F, 0.1F, 0.0F, 0.1F}, 0.8F);

void expectMotion(const FittedMotion& found, const FittedMotion& wanted, float within) {
  for (std::size_t part = 0; part < ImageMotion::kParts; ++part) {
    EXPECT_NEAR(found.motion.velocity[part], wanted.motion.velocity[part], within) << part;
    EXPECT_NEAR(found.motion.curvature[part], wanted.motion.curvature[part], within) << part;
  }
}

TEST(MotionEquations, AStepSolvesALinearProblem) {
  FittedMotion found = kStart;
  const double largest = Linear(kWanted, found).equations.step(true, found);
  expectMotion(found, kWanted, 0.01F);
  EXPECT_NEAR(found.event_share, kWanted.event_share, 0.01F);
  EXPECT_NEAR(largest, 3.0, 0.01);
}

TEST(MotionEquations, TheShareOfEventsStaysWhereItIsHeldAndAtItsBound) {
  FittedMotion held = kStart;
  Linear(kWanted, held).equations.step(false, held);
  EXPECT_EQ(held.event_share, 1.0F);

  FittedMotion wanted = kWanted;
  wanted.event_share = 1.2F;
  FittedMotion bound = kStart;
  bound.event_share = 0.9F;
  Linear(wanted, bound).equations.step(true, bound);
  EXPECT_NEAR(bound.event_share, 1.0F, 1e-6F);
}

TEST(MotionEquations, NothingIsExpectedWhereNothingWasAdded) {
  MotionEquations equations;
  FittedMotion fitted = kWanted;
  equations.addPriors(fitted);
  equations.step(true, fitted);
  expectMotion(fitted, kStart, 1e-5F);
  EXPECT_NEAR(fitted.event_share, 1.0F, 1e-5F);
}

TEST(MotionEquations, MeasuresWayAndDeviation) {
  FittedMotion fitted = motionOf({3.0F, 4.0F}, {}, 1.0F);
  const Linear linear(fitted, fitted);
  linear.equations.measure(kSize, fitted);
  EXPECT_TRUE(fitted.found);
  EXPECT_NEAR(fitted.path_px, 10.0F, 1e-4F);
  EXPECT_NEAR(fitted.reach_px, 5.0F, 1e-4F);
  EXPECT_NEAR(linear.equations.variance(), 1e-6, 1e-9);
  EXPECT_GT(fitted.deviation_px, 0.0F);
  EXPECT_LT(fitted.deviation_px, 0.001F);
}

/// Gradients along one part of the motion each: the parts do not depend on each other, so that
/// their deviations, and what is expected of them beforehand, add up in closed form.
TEST(MotionEquations, DeviationIsThatOfThePartsAndOfWhatIsExpected) {
  constexpr double kSquares[] = {5.0, 3.0, 0.4, 0.6, 0.02, 0.01};
  constexpr double kUsualVelocities_px[] = {30.0, 30.0, 30.0, 30.0, 3.0, 3.0};
  constexpr double kUsualCurvatures_px[] = {10.0, 10.0, 10.0, 10.0, 3.0, 3.0};
  constexpr double kVariance = 0.5;
  FittedMotion fitted =
      motionOf({3.0F, 4.0F, 1.0F, -0.5F, 0.3F, 0.2F}, {1.0F, -0.5F, 0.2F, 0.1F, 0.0F, 0.1F}, 1.0F);
  MotionEquations equations;
  for (const double tau : kTaus) {
    MotionEquations::Sums sums;
    for (std::size_t part = 0; part < ImageMotion::kParts; ++part) {
      sums.squares[part][part] = static_cast<float>(kSquares[part]);
    }
    sums.weight = 40.0F;
    sums.residuals = 20.0F;
    equations.add(sums, tau);
  }
  EXPECT_DOUBLE_EQ(equations.variance(), kVariance);
  equations.addPriors(fitted);
  equations.measure(kSize, fitted);

  double ways = 0.0;
  double reach = 0.0;
  double largest = 0.0;
  for (const auto& [x_px, y_px] :
       {std::pair{0.0F, 0.0F}, {159.0F, 0.0F}, {0.0F, 119.0F}, {159.0F, 119.0F}, {79.5F, 59.5F}}) {
    const auto x = static_cast<double>(fitted.motion.relativeX(x_px));
    const auto y = static_cast<double>(fitted.motion.relativeY(y_px));
    const double basis_x[] = {1.0, 0.0, x, -y, x * x, x * y};
    const double basis_y[] = {0.0, 1.0, y, x, x * y, y * y};
    for (const double tau : {-1.0, 1.0}) {
      const Displacement u = fitted.motion.displacement(x_px, y_px, static_cast<float>(tau));
      const double way = std::hypot(static_cast<double>(u.x), static_cast<double>(u.y));
      ways += way;
      reach = std::max(reach, way);
      double variance = 0.0;
      for (std::size_t part = 0; part < ImageMotion::kParts; ++part) {
        // The normal equations of velocity and curvature of one part.
        double vv = kVariance / std::pow(kUsualVelocities_px[part], 2);
        double cc = kVariance / std::pow(kUsualCurvatures_px[part], 2);
        double vc = 0.0;
        for (const double at : kTaus) {
          vv += kSquares[part] * std::pow(at, 2);
          vc += kSquares[part] * std::pow(at, 3);
          cc += kSquares[part] * std::pow(at, 4);
        }
        const double of_displacement =
            (tau * tau * cc - 2.0 * tau * vc + vv) / (vv * cc - vc * vc);  // tau^2 is 1
        variance += 4.0 * kVariance * of_displacement *
                    (std::pow(basis_x[part], 2) + std::pow(basis_y[part], 2)) / 2.0;
      }
      largest = std::max(largest, variance);
    }
  }
  EXPECT_NEAR(static_cast<double>(fitted.path_px), ways / 5.0, 1e-5);
  EXPECT_NEAR(static_cast<double>(fitted.reach_px), reach, 1e-5);
  EXPECT_NEAR(static_cast<double>(fitted.deviation_px), std::sqrt(largest), 1e-5);
}

TEST(MotionEquations, TheVarianceOfNothingIsNotZero) {
  EXPECT_EQ(MotionEquations().variance(), 1e-6);
  MotionEquations::Sums sums;
  sums.weight = 0.5F;
  sums.residuals = 0.25F;
  MotionEquations equations;
  equations.add(sums, 1.0);
  EXPECT_EQ(equations.variance(), 0.25);  // of less than a pixel as of one
}

}  // namespace
}  // namespace fast_edi
