/// \file
/// How far an estimated trajectory, e.g. of visual-inertial odometry, lies from the true one.
///
/// The absolute trajectory error (ATE) is what remains after the estimate was laid over the truth
/// as well as it fits (Sturm et al., IROS 2012; Zhang and Scaramuzza, IROS 2018).
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "fast_edi/base/types.hpp"

namespace fast_edi {

struct TimedPosition {
  std::int64_t t_ns = 0;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< [m]
};

/// What an estimate may be moved by before it is compared.
enum class TrajectoryAlignment {
  kYaw,         ///< translation and rotation about z: what visual-inertial odometry cannot know
  kRigid,       ///< translation and rotation
  kSimilarity,  ///< those and scale
};

/// \throws std::invalid_argument listing the names that are known: yaw, se3, sim3
TrajectoryAlignment trajectoryAlignmentFromName(const std::string& name);

struct TrajectoryComparison {
  TrajectoryAlignment alignment = TrajectoryAlignment::kYaw;
  /// A longer pause of the estimate is a reset of the estimator; over a longer pause of the truth
  /// nothing is interpolated.
  std::int64_t max_gap_ns = kNanosecondsPerSecond / 2;
};

struct TrajectoryError {
  std::size_t compared = 0;  ///< estimates whose instant the truth covers
  std::size_t left_out = 0;  ///< the other estimates, and those that are no numbers
  double rmse_m = 0.0;       ///< absolute trajectory error
  double median_m = 0.0;     ///< of the distances that rmse_m is made of
  double largest_m = 0.0;
  /// Drift at the end: from where the truth went between the first and the last estimate to where
  /// the estimate went. With the same place at both it is the distance of the estimate's ends.
  double end_drift_m = 0.0;
  double scale = 1.0;          ///< that the estimate was multiplied by; 1 unless kSimilarity
  double path_length_m = 0.0;  ///< of the whole truth
  double tracked_share = 0.0;  ///< of the truth's time, without the estimate's pauses
  std::size_t resets = 0;      ///< pauses between estimates
  std::vector<Eigen::Vector3d> truth;     ///< at the compared instants
  std::vector<Eigen::Vector3d> estimate;  ///< aligned with them
};

/// Compares positions by their time, with the truth interpolated linearly. Both may come in any
/// order. The alignment is one for the whole trajectory: a reset that moves the origin counts as
/// the error that it is to a user.
/// \throws std::invalid_argument when fewer than three estimates can be compared, when all true
/// positions are of one instant, or when the scale is wanted of an estimate that does not move
TrajectoryError compareTrajectories(std::vector<TimedPosition> estimate,
                                    std::vector<TimedPosition> truth,
                                    const TrajectoryComparison& comparison);

}  // namespace fast_edi
