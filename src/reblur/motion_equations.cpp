#include "reblur/motion_equations.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Cholesky>

namespace fast_edi {
namespace {

constexpr std::size_t kParts = ImageMotion::kParts;
constexpr std::size_t kFirstTilt = 4;  ///< of the parts
/// Velocities, curvatures and tilts [px]: they decide only what the events leave open.
constexpr double kUsualVelocity_px = 30.0;
constexpr double kUsualCurvature_px = 10.0;
constexpr double kUsualTilt_px = 3.0;
constexpr double kUsualLoss = 0.03;  ///< of the share of events
constexpr double kMostShare = 1.0;   ///< no sensor invents a change
constexpr double kLeastVariance = 1e-6;
/// Pixels that count as one.
constexpr double kCorrelated = 4.0;
constexpr float kHalf = 0.5F;

}  // namespace

void MotionEquations::add(const Sums& sums, double tau) {
  const double factors[3] = {tau, tau * tau, 1.0};  // of c1, c2 and the share of events
  const auto slope_of = [](std::size_t row) {
    return row == std::size_t{kShareRow} ? kParts : row % kParts;
  };
  for (std::size_t i = 0; i < std::size_t{kRows}; ++i) {
    const std::size_t row = slope_of(i);
    const double factor = factors[i / kParts];
    right_[static_cast<Eigen::Index>(i)] += factor * static_cast<double>(sums.products[row]);
    for (std::size_t j = 0; j < std::size_t{kRows}; ++j) {
      const std::size_t column = slope_of(j);
      const float square = sums.squares[std::max(row, column)][std::min(row, column)];
      matrix_(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) +=
          factor * factors[j / kParts] * static_cast<double>(square);
    }
  }
  weight_ += static_cast<double>(sums.weight);
  residuals_ += static_cast<double>(sums.residuals);
}

void MotionEquations::addPriors(const FittedMotion& fitted) {
  const auto add_prior = [this](std::size_t row, double usual, double deviation) {
    const auto index = static_cast<Eigen::Index>(row);
    const double precision = variance() / (usual * usual);
    matrix_(index, index) += precision;
    right_[index] += precision * deviation;
  };
  for (std::size_t i = 0; i < kParts; ++i) {
    const bool is_tilt = i >= kFirstTilt;
    add_prior(i, is_tilt ? kUsualTilt_px : kUsualVelocity_px,
              static_cast<double>(fitted.motion.velocity[i]));
    add_prior(kParts + i, is_tilt ? kUsualTilt_px : kUsualCurvature_px,
              static_cast<double>(fitted.motion.curvature[i]));
  }
  add_prior(std::size_t{kShareRow}, kUsualLoss,
            static_cast<double>(fitted.event_share) - kMostShare);
}

double MotionEquations::variance() const {
  return std::max(kLeastVariance, residuals_ / std::max(1.0, weight_));
}

/// What is to be subtracted from the unknowns.
MotionEquations::Vector MotionEquations::solve(float event_share) const {
  const Vector change = matrix_.ldlt().solve(right_);
  const double to_bound = static_cast<double>(event_share) - kMostShare;
  return change[kShareRow] < to_bound ? solveHeld(to_bound) : change;
}

/// The same with a given change of the share of events.
MotionEquations::Vector MotionEquations::solveHeld(double share_change) const {
  const Eigen::Matrix<double, kMotionRows, kMotionRows> motion =
      matrix_.topLeftCorner<kMotionRows, kMotionRows>();
  Vector change;
  change << motion.ldlt().solve(right_.head<kMotionRows>() -
                                share_change * matrix_.col(kShareRow).head<kMotionRows>()),
      share_change;
  return change;
}

double MotionEquations::step(bool share_is_free, FittedMotion& fitted) const {
  const Vector change = share_is_free ? solve(fitted.event_share) : solveHeld(0.0);
  for (std::size_t part = 0; part < kParts; ++part) {
    const auto index = static_cast<Eigen::Index>(part);
    fitted.motion.velocity[part] -= static_cast<float>(change[index]);
    fitted.motion.curvature[part] -=
        static_cast<float>(change[index + static_cast<Eigen::Index>(kParts)]);
  }
  fitted.event_share -= static_cast<float>(change[kShareRow]);
  return change.head<kMotionRows>().cwiseAbs().maxCoeff();
}

void MotionEquations::measure(SensorSize size, FittedMotion& fitted) const {
  using MotionMatrix = Eigen::Matrix<double, kMotionRows, kMotionRows>;
  const MotionMatrix precision = matrix_.topLeftCorner<kMotionRows, kMotionRows>();
  const MotionMatrix covariance =
      kCorrelated * variance() * precision.ldlt().solve(MotionMatrix::Identity());
  const auto right = static_cast<float>(size.width - 1);
  const auto bottom = static_cast<float>(size.height - 1);
  const std::array<Displacement, 5> places = {{{0.0F, 0.0F},
                                               {right, 0.0F},
                                               {0.0F, bottom},
                                               {right, bottom},
                                               {kHalf * right, kHalf * bottom}}};
  double largest_variance = 0.0;
  float ways = 0.0F;
  for (const Displacement& place : places) {
    const auto x = static_cast<double>(fitted.motion.relativeX(place.x));
    const auto y = static_cast<double>(fitted.motion.relativeY(place.y));
    for (const double tau : {-1.0, 1.0}) {
      const Displacement u = fitted.motion.displacement(place.x, place.y, static_cast<float>(tau));
      const float way = std::hypot(u.x, u.y);
      ways += way;
      fitted.reach_px = std::max(fitted.reach_px, way);
      Eigen::Matrix<double, 2, static_cast<int>(kParts)> basis;
      basis << 1.0, 0.0, x, -y, x * x, x * y,  //
          0.0, 1.0, y, x, x * y, y * y;
      Eigen::Matrix<double, 2, kMotionRows> slope;
      slope << tau * basis, basis;
      const Eigen::Matrix2d variance = slope * covariance * slope.transpose();
      largest_variance = std::max(largest_variance, 0.5 * variance.trace());
    }
  }
  fitted.path_px = ways / static_cast<float>(places.size());
  fitted.deviation_px = static_cast<float>(std::sqrt(largest_variance));
  fitted.found = std::isfinite(fitted.path_px) && std::isfinite(fitted.deviation_px);
}

}  // namespace fast_edi
