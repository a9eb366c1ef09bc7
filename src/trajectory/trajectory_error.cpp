#include "trajectory/trajectory_error.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include <Eigen/Geometry>

namespace fast_edi {
namespace {

/// With two, a line could be turned about itself.
constexpr std::size_t kFewestPositions = 3;

bool isEarlier(const TimedPosition& a, const TimedPosition& b) {
  return a.t_ns < b.t_ns;
}

/// \param sorted by time
std::optional<Eigen::Vector3d> positionAt(const std::vector<TimedPosition>& sorted,
                                          std::int64_t t_ns, std::int64_t max_gap_ns) {
  const auto after =
      std::lower_bound(sorted.begin(), sorted.end(), TimedPosition{t_ns, {}}, isEarlier);
  if (after == sorted.end()) {
    return std::nullopt;
  }
  if (after->t_ns == t_ns) {
    return after->position;
  }
  if (after == sorted.begin()) {
    return std::nullopt;
  }
  const TimedPosition& before = *std::prev(after);
  const std::int64_t gap_ns = after->t_ns - before.t_ns;
  if (gap_ns > max_gap_ns) {
    return std::nullopt;
  }
  const double part = static_cast<double>(t_ns - before.t_ns) / static_cast<double>(gap_ns);
  return before.position + part * (after->position - before.position);
}

Eigen::Matrix3Xd columnsOf(const std::vector<Eigen::Vector3d>& points) {
  Eigen::Matrix3Xd columns(3, points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    columns.col(static_cast<Eigen::Index>(i)) = points[i];
  }
  return columns;
}

/// The least-squares transformation from \p from to \p to.
Eigen::Affine3d align(const Eigen::Matrix3Xd& from, const Eigen::Matrix3Xd& to,
                      TrajectoryAlignment alignment) {
  Eigen::Affine3d transform = Eigen::Affine3d::Identity();
  if (alignment == TrajectoryAlignment::kYaw) {
    // Heights do not depend on the yaw: a problem of the plane.
    const Eigen::MatrixXd plane =
        Eigen::umeyama(Eigen::MatrixXd(from.topRows(2)), Eigen::MatrixXd(to.topRows(2)), false);
    transform.linear().topLeftCorner<2, 2>() = plane.topLeftCorner<2, 2>();
    transform.translation() = to.rowwise().mean() - transform.linear() * from.rowwise().mean();
  } else {
    transform.matrix() = Eigen::umeyama(from, to, alignment == TrajectoryAlignment::kSimilarity);
  }
  return transform;
}

double pathLength(const std::vector<TimedPosition>& sorted) {
  double length = 0.0;
  for (std::size_t i = 1; i < sorted.size(); ++i) {
    length += (sorted[i].position - sorted[i - 1].position).norm();
  }
  return length;
}

bool standsStill(const std::vector<Eigen::Vector3d>& positions) {
  return std::all_of(positions.begin(), positions.end(),
                     [&](const Eigen::Vector3d& position) { return position == positions[0]; });
}

}  // namespace

TrajectoryAlignment trajectoryAlignmentFromName(const std::string& name) {
  if (name == "yaw") return TrajectoryAlignment::kYaw;
  if (name == "se3") return TrajectoryAlignment::kRigid;
  if (name == "sim3") return TrajectoryAlignment::kSimilarity;
  throw std::invalid_argument("alignment \"" + name + "\" is not known, expected yaw, se3 or sim3");
}

TrajectoryError compareTrajectories(std::vector<TimedPosition> estimate,
                                    std::vector<TimedPosition> truth,
                                    const TrajectoryComparison& comparison) {
  std::stable_sort(estimate.begin(), estimate.end(), isEarlier);
  std::stable_sort(truth.begin(), truth.end(), isEarlier);
  TrajectoryError error;
  error.path_length_m = pathLength(truth);
  std::int64_t tracked_ns = 0;
  std::optional<std::int64_t> last_ns;
  for (const TimedPosition& timed : estimate) {
    const std::optional<Eigen::Vector3d> true_position =
        positionAt(truth, timed.t_ns, comparison.max_gap_ns);
    if (!true_position || !timed.position.allFinite()) {
      ++error.left_out;
      continue;
    }
    error.truth.push_back(*true_position);
    error.estimate.push_back(timed.position);
    const std::int64_t pause_ns = timed.t_ns - last_ns.value_or(timed.t_ns);
    if (pause_ns > comparison.max_gap_ns) {
      ++error.resets;
    } else {
      tracked_ns += pause_ns;
    }
    last_ns = timed.t_ns;
  }
  error.compared = error.truth.size();
  if (error.compared < kFewestPositions) {
    throw std::invalid_argument("expected at least " + std::to_string(kFewestPositions) +
                                " estimates at instants with truth, found " +
                                std::to_string(error.compared) + " of " +
                                std::to_string(estimate.size()));
  }
  const std::int64_t span_ns = truth.back().t_ns - truth.front().t_ns;
  if (span_ns <= 0) {
    throw std::invalid_argument("expected true poses at several instants, found all " +
                                std::to_string(truth.size()) + " of them at one");
  }
  error.tracked_share = static_cast<double>(tracked_ns) / static_cast<double>(span_ns);
  if (comparison.alignment == TrajectoryAlignment::kSimilarity && standsStill(error.estimate)) {
    throw std::invalid_argument(
        "expected an estimate that moves: a single place has no scale, use the alignment se3");
  }

  const Eigen::Affine3d transform =
      align(columnsOf(error.estimate), columnsOf(error.truth), comparison.alignment);
  error.scale = std::cbrt(transform.linear().determinant());
  std::vector<double> distances;
  double squares = 0.0;
  for (std::size_t i = 0; i < error.compared; ++i) {
    error.estimate[i] = transform * error.estimate[i];
    distances.push_back((error.estimate[i] - error.truth[i]).norm());
    squares += distances.back() * distances.back();
  }
  error.rmse_m = std::sqrt(squares / static_cast<double>(error.compared));
  error.end_drift_m = ((error.estimate.back() - error.estimate.front()) -
                       (error.truth.back() - error.truth.front()))
                          .norm();
  std::sort(distances.begin(), distances.end());
  error.median_m = distances[distances.size() / 2];
  error.largest_m = distances.back();
  return error;
}

}  // namespace fast_edi
