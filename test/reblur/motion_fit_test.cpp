#include "reblur/motion_fit.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "fast_edi/events/event_counts.hpp"
#include "reblur/moving_plane.hpp"
#include "support/event_generators.hpp"

namespace fast_edi {
namespace {

using testing::kPlaneSize;

/// Root mean square over the image's corners, edges and centre at start and end of the exposure
/// [px].
double errorOf(const ImageMotion& motion, const SimulationSettings& settings,
               const ExposureInterval& exposure) {
  const CameraMotion camera(settings.motion, kPlaneSize, settings.focalLengthPx(), settings.seed);
  const auto plane = [&](std::int64_t t_ns) {
    return camera.imageToPlaneAt(t_ns - settings.timing.start_ns);
  };
  const cv::Matx33d to_middle = plane(exposure.at(ExposureInstant::kMid)).inv();
  double squares = 0.0;
  int count = 0;
  for (const double tau : {-1.0, 1.0}) {
    const cv::Matx33d moved = to_middle * plane(tau < 0.0 ? exposure.start_ns : exposure.end_ns);
    for (const double x : {0.0, 80.0, 159.0}) {
      for (const double y : {0.0, 60.0, 119.0}) {
        const cv::Vec3d to = moved * cv::Vec3d(x, y, 1.0);
        const Displacement u = motion.displacement(static_cast<float>(x), static_cast<float>(y),
                                                   static_cast<float>(tau));
        squares += std::pow(static_cast<double>(u.x) - (to[0] / to[2] - x), 2) +
                   std::pow(static_cast<double>(u.y) - (to[1] / to[2] - y), 2);
        ++count;
      }
    }
  }
  return std::sqrt(squares / count);
}

/// Fits the motion of the last frame, with the true image of mid-exposure.
class MotionFitTest : public ::testing::Test {
 protected:
  void fit(const SimulationSettings& settings) {
    SimulatedSequence sequence = simulateSequence(settings);
    loseSome(sequence.events);
    const SimulatedFrame& frame = sequence.frames.back();
    PixelEventLists lists(kPlaneSize, {});
    lists.keepIntervals(true);
    lists.append(testing::wireView(testing::toWire(sequence.events)));
    EventCounts counts(kPlaneSize);
    counts.count(lists, frame.exposure);
    std::vector<float> mean_counts(kPlaneSize.pixelCount());
    std::vector<float> log_image;
    for (int y = 0; y < kPlaneSize.height; ++y) {
      for (int x = 0; x < kPlaneSize.width; ++x) {
        log_image.push_back(
            std::log(static_cast<float>(frame.sharp.at<std::uint8_t>(y, x)) + 3.0F));
        const auto i = static_cast<std::size_t>(y) * kPlaneSize.width + static_cast<std::size_t>(x);
        mean_counts[i] = static_cast<float>(counts.off(i) + counts.on(i));
      }
    }
    EventChanges changes;
    LaterQuarters quarters(kPlaneSize);
    quarters.count(lists, frame.exposure);
    changes.measure(lists, frame.exposure, counts.data(), quarters,
                    {settings.sensor.thresholds, {4 * kNanosecondsPerMillisecond, 0.85}});
    fitted_ = MotionFit(kPlaneSize)
                  .fit(log_image.data(), changes, mean_counts.data(),
                       static_cast<float>(settings.sensor.thresholds.on));
    exposure_ = frame.exposure;
  }

  /// Takes out one of so many events, evenly over each pixel's; 0: none.
  std::size_t lost_one_of_ = 0;
  FittedMotion fitted_;
  ExposureInterval exposure_;

 private:
  void loseSome(std::vector<Event>& events) const {
    if (lost_one_of_ == 0) return;
    std::vector<std::size_t> seen(kPlaneSize.pixelCount());
    events.erase(std::remove_if(events.begin(), events.end(),
                                [&](const Event& event) {
                                  const auto pixel =
                                      std::size_t{event.y} * kPlaneSize.width + event.x;
                                  return (++seen[pixel] + pixel) % lost_one_of_ == 0;
                                }),
                 events.end());
  }
};

TEST_F(MotionFitTest, FindsAPathThatCurves) {
  const SimulationSettings settings = testing::movingPlane(MotionKind::kMild, 4.0);
  fit(settings);
  ASSERT_TRUE(fitted_.found);
  EXPECT_GT(fitted_.path_px, 2.0F);
  EXPECT_LT(errorOf(fitted_.motion, settings, exposure_), 0.4);
  EXPECT_LT(fitted_.deviation_px, 0.4F);
}

TEST_F(MotionFitTest, FindsARotation) {
  const SimulationSettings settings = testing::movingPlane(MotionKind::kSpin, 1.0);
  fit(settings);
  ASSERT_TRUE(fitted_.found);
  EXPECT_LT(errorOf(fitted_.motion, settings, exposure_), 0.4);
}

TEST_F(MotionFitTest, FindsTheSameMotionWhereEventsAreLost) {
  const SimulationSettings settings = testing::movingPlane(MotionKind::kSpin, 1.0);
  fit(settings);
  const float path_px = fitted_.path_px;
  EXPECT_GT(fitted_.event_share, 0.9F);
  EXPECT_LE(fitted_.event_share, 1.0F);
  lost_one_of_ = 4;
  fit(settings);
  ASSERT_TRUE(fitted_.found);
  EXPECT_NEAR(fitted_.event_share, 0.75F, 0.08F);
  EXPECT_NEAR(fitted_.path_px, path_px, 0.05F * path_px);
  EXPECT_LT(errorOf(fitted_.motion, settings, exposure_), 0.5);
}

TEST_F(MotionFitTest, FindsNothingWhereNothingMoves) {
  fit(testing::movingPlane(MotionKind::kStill, 1.0));
  EXPECT_FALSE(fitted_.found);
  EXPECT_EQ(fitted_.path_px, 0.0F);
  EXPECT_EQ(fitted_.event_share, 1.0F);
}

}  // namespace
}  // namespace fast_edi
