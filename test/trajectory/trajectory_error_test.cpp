#include "trajectory/trajectory_error.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <Eigen/Geometry>

#include "evaluation/message_of.hpp"
#include "trajectory/trajectory_plot.hpp"

namespace fast_edi {
namespace {

using testing::HasSubstr;

constexpr std::int64_t kPeriod_ns = kNanosecondsPerSecond / 10;
constexpr double kTolerance_m = 1e-9;

/// A closed loop that rises and falls, 10 s long.
std::vector<TimedPosition> loop() {
  std::vector<TimedPosition> positions;
  constexpr int kCount = 101;
  for (int i = 0; i < kCount; ++i) {
    const double angle = 2.0 * M_PI * i / (kCount - 1);
    positions.push_back(
        {i * kPeriod_ns, {3.0 * std::cos(angle), 2.0 * std::sin(angle), 0.5 * std::sin(angle)}});
  }
  return positions;
}

std::vector<TimedPosition> moved(std::vector<TimedPosition> positions,
                                 const Eigen::Affine3d& motion) {
  for (TimedPosition& timed : positions) {
    timed.position = motion * timed.position;
  }
  return positions;
}

Eigen::Affine3d rotation(double angle, const Eigen::Vector3d& axis) {
  return Eigen::Affine3d(Eigen::Translation3d(7.0, -4.0, 1.5) *
                         Eigen::AngleAxisd(angle, axis.normalized()));
}

TrajectoryError compare(const std::vector<TimedPosition>& estimate,
                        TrajectoryAlignment alignment = TrajectoryAlignment::kYaw) {
  TrajectoryComparison comparison;
  comparison.alignment = alignment;
  return compareTrajectories(estimate, loop(), comparison);
}

TEST(TrajectoryErrorTest, AnotherOriginAndHeadingAreNoError) {
  const TrajectoryError error = compare(moved(loop(), rotation(2.0, Eigen::Vector3d::UnitZ())));
  EXPECT_NEAR(error.rmse_m, 0.0, kTolerance_m);
  EXPECT_NEAR(error.end_drift_m, 0.0, kTolerance_m);
  EXPECT_EQ(error.compared, 101U);
  EXPECT_EQ(error.left_out, 0U);
  EXPECT_EQ(error.resets, 0U);
  EXPECT_DOUBLE_EQ(error.tracked_share, 1.0);
  EXPECT_NEAR(error.path_length_m, 16.04, 0.01);
}

TEST(TrajectoryErrorTest, ATiltIsAnErrorUnlessRotationIsAligned) {
  const std::vector<TimedPosition> tilted = moved(loop(), rotation(0.3, {1.0, 0.5, 0.2}));
  EXPECT_GT(compare(tilted).rmse_m, 0.2);
  EXPECT_NEAR(compare(tilted, TrajectoryAlignment::kRigid).rmse_m, 0.0, kTolerance_m);
}

TEST(TrajectoryErrorTest, AWrongScaleIsAnErrorUnlessScaleIsAligned) {
  Eigen::Affine3d motion = rotation(1.0, Eigen::Vector3d::UnitZ());
  motion.scale(0.8);
  const std::vector<TimedPosition> small = moved(loop(), motion);
  // A fifth of the distance to the middle, of 2.6 m in the mean square.
  EXPECT_NEAR(compare(small).rmse_m, 0.2 * std::sqrt((9.0 + 4.0 + 0.25) / 2.0), 0.01);
  EXPECT_NEAR(compare(small).scale, 1.0, kTolerance_m);
  const TrajectoryError error = compare(small, TrajectoryAlignment::kSimilarity);
  EXPECT_NEAR(error.rmse_m, 0.0, kTolerance_m);
  EXPECT_NEAR(error.scale, 1.25, kTolerance_m);
}

TEST(TrajectoryErrorTest, DriftIsWhatTheEndLacksToTheStart) {
  std::vector<TimedPosition> drifting = loop();
  const Eigen::Vector3d drift(0.3, -0.4, 1.2);
  for (std::size_t i = 0; i < drifting.size(); ++i) {
    drifting[i].position += drift * static_cast<double>(i) / 100.0;
  }
  const TrajectoryError error = compare(drifting);
  // The alignment may turn the estimate, but start and end of the truth are the same.
  EXPECT_NEAR(error.end_drift_m, 1.3, 1e-6);
  EXPECT_GT(error.rmse_m, 0.2);
  EXPECT_LT(error.rmse_m, 1.3);
  EXPECT_GE(error.largest_m, error.rmse_m);
}

TEST(TrajectoryErrorTest, TruthIsInterpolatedAndOrderDoesNotMatter) {
  std::vector<TimedPosition> sparse = loop();
  const std::vector<TimedPosition> truth = loop();
  std::vector<TimedPosition> estimate;
  for (std::size_t i = 100; i > 0; --i) {
    estimate.push_back(
        {truth[i].t_ns - kPeriod_ns / 4, 0.75 * truth[i].position + 0.25 * truth[i - 1].position});
  }
  EXPECT_NEAR(compare(estimate).rmse_m, 0.0, kTolerance_m);
}

TEST(TrajectoryErrorTest, PausesCountAsResetsAndAreNotTracked) {
  std::vector<TimedPosition> estimate = loop();
  estimate.erase(estimate.begin() + 20, estimate.begin() + 40);  // 2.1 s apart
  estimate.erase(estimate.begin(), estimate.begin() + 10);       // late by 1 s
  const TrajectoryError error = compare(estimate);
  EXPECT_EQ(error.resets, 1U);
  EXPECT_NEAR(error.tracked_share, 1.0 - 0.21 - 0.1, kTolerance_m);
}

TEST(TrajectoryErrorTest, EstimatesWithoutTruthAreLeftOutAndCounted) {
  std::vector<TimedPosition> estimate = loop();
  estimate.push_back({-kPeriod_ns, {0.0, 0.0, 0.0}});
  estimate.push_back({200 * kPeriod_ns, {0.0, 0.0, 0.0}});
  estimate[5].position.x() = std::numeric_limits<double>::quiet_NaN();
  const TrajectoryError error = compare(estimate);
  EXPECT_EQ(error.left_out, 3U);
  EXPECT_EQ(error.compared, 100U);
  EXPECT_NEAR(error.rmse_m, 0.0, kTolerance_m);
}

TEST(TrajectoryErrorTest, TooLittleToCompareIsRefused) {
  std::vector<TimedPosition> two = loop();
  two.resize(2);
  EXPECT_THAT(messageOf<std::invalid_argument>([&] { compare(two); }), HasSubstr("found 2 of 2"));
  EXPECT_THAT(messageOf<std::invalid_argument>([] { trajectoryAlignmentFromName("best"); }),
              HasSubstr("expected yaw, se3 or sim3"));
}

TEST(TrajectoryErrorTest, TruthOfOneInstantIsRefused) {
  const std::vector<TimedPosition> same(4, loop().front());
  EXPECT_THAT(messageOf<std::invalid_argument>([&] { compareTrajectories(same, same, {}); }),
              HasSubstr("found all 4 of them at one"));
}

TEST(TrajectoryErrorTest, AnEstimateThatStandsStillHasNoScale) {
  std::vector<TimedPosition> still = loop();
  for (TimedPosition& timed : still) {
    timed.position.setZero();
  }
  EXPECT_GT(compare(still).rmse_m, 1.0);
  EXPECT_THAT(
      messageOf<std::invalid_argument>([&] { compare(still, TrajectoryAlignment::kSimilarity); }),
      HasSubstr("a single place has no scale"));
}

TEST(TrajectoryPlotTest, DrawsBothWithinThePicture) {
  const TrajectoryError error = compare(loop());
  const cv::Mat plot = topViewPlot("loop", error);
  EXPECT_EQ(plot.type(), CV_8UC3);
  int coloured = 0;
  for (int y = 0; y < plot.rows; ++y) {
    for (int x = 0; x < plot.cols; ++x) {
      const cv::Vec3b pixel = plot.at<cv::Vec3b>(y, x);
      coloured += pixel[0] != pixel[2] ? 1 : 0;
    }
  }
  EXPECT_GT(coloured, 1000);
}

}  // namespace
}  // namespace fast_edi
