/// \file
/// Normal equations of a motion and of the share of events: one step of MotionFit.
#pragma once

#include <cstddef>

#include <Eigen/Core>

#include "fast_edi/base/types.hpp"
#include "reblur/fitted_motion.hpp"

namespace fast_edi {

class MotionEquations {
 public:
  /// Of a residual: by the parts of the motion, and by the share of events.
  static constexpr std::size_t kSlopes = ImageMotion::kParts + 1;

  /// Of the residuals r at one instant, with their slopes J by B(x) c and by the share of events.
  struct Sums {
    float squares[kSlopes][kSlopes] = {};  ///< J^T W J, the lower half
    float products[kSlopes] = {};          ///< J^T W r
    float weight = 0.0F;
    float residuals = 0.0F;  ///< weighted squares
  };

  /// \param tau of the instant, see ImageMotion
  void add(const Sums& sums, double tau);
  /// What is expected before any event is looked at. \pre all instants have been added
  void addPriors(const FittedMotion& fitted);

  /// Of a residual of weight 1.
  double variance() const;

  /// Takes a step of Gauss-Newton. A share of events that would become larger than 1 becomes 1.
  /// \param share_is_free false: the share of events stays
  /// \return largest change of a part of the motion [px]
  double step(bool share_is_free, FittedMotion& fitted) const;

  /// Way and deviation over corners and centre of the image at start and end; the share of events
  /// is taken for exact.
  void measure(SensorSize size, FittedMotion& fitted) const;

 private:
  static constexpr int kMotionRows = 2 * static_cast<int>(ImageMotion::kParts);
  static constexpr int kShareRow = kMotionRows;
  static constexpr int kRows = kMotionRows + 1;
  using Matrix = Eigen::Matrix<double, kRows, kRows>;
  using Vector = Eigen::Matrix<double, kRows, 1>;

  Vector solve(float event_share) const;
  Vector solveHeld(double share_change) const;

  // Not vectorised by Eigen, whose alignment would bind all that holds one.
  Eigen::Matrix<double, kRows, kRows, Eigen::DontAlign> matrix_ = Matrix::Zero();
  Eigen::Matrix<double, kRows, 1, Eigen::DontAlign> right_ = Vector::Zero();
  double weight_ = 0.0;
  double residuals_ = 0.0;
};

}  // namespace fast_edi
