#include "reblur/motion_fit.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "fast_edi/events/event_counts.hpp"
#include "reblur/moving_plane.hpp"
#include "reblur/slow_motion_fit.hpp"
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
    mean_counts_.resize(kPlaneSize.pixelCount());
    log_image_.clear();
    for (int y = 0; y < kPlaneSize.height; ++y) {
      for (int x = 0; x < kPlaneSize.width; ++x) {
        log_image_.push_back(
            std::log(static_cast<float>(frame.sharp.at<std::uint8_t>(y, x)) + 3.0F));
        const auto i = static_cast<std::size_t>(y) * kPlaneSize.width + static_cast<std::size_t>(x);
        mean_counts_[i] = static_cast<float>(counts.off(i) + counts.on(i));
      }
    }
    LaterQuarters quarters(kPlaneSize);
    quarters.count(lists, frame.exposure);
    changes_.measure(lists, frame.exposure, counts.data(), quarters,
                     {settings.sensor.thresholds, {4 * kNanosecondsPerMillisecond, 0.85}});
    contrast_ = static_cast<float>(settings.sensor.thresholds.on);
    fitted_ = fit();
    exposure_ = frame.exposure;
  }

  /// The same once more, of what was changed since.
  FittedMotion fit() const {
    std::vector<float> image = log_image_;
    image.insert(image.end(), kPlaneSize.width, 1e9F);  // no part of it
    return MotionFit(kPlaneSize).fit(image.data(), changes_, mean_counts_.data(), contrast_);
  }

  /// To the image.
  void addNoise(float sigma) {
    std::mt19937 random(3);
    std::normal_distribution<float> noise(0.0F, sigma);
    for (float& level : log_image_) level += noise(random);
  }

  void expectTheSlowFit() const {
    const FittedMotion found = fit();
    const FittedMotion expected =
        testing::SlowMotionFit(kPlaneSize, log_image_, changes_, mean_counts_)
            .fit(static_cast<double>(contrast_));
    constexpr float kRounding_px = 5e-4F;
    for (std::size_t part = 0; part < ImageMotion::kParts; ++part) {
      EXPECT_NEAR(found.motion.velocity[part], expected.motion.velocity[part], kRounding_px)
          << part;
      EXPECT_NEAR(found.motion.curvature[part], expected.motion.curvature[part], kRounding_px)
          << part;
    }
    EXPECT_NEAR(found.event_share, expected.event_share, 1e-5F);
    EXPECT_NEAR(found.deviation_px, expected.deviation_px, kRounding_px);
    EXPECT_NEAR(found.path_px, expected.path_px, kRounding_px);
    EXPECT_NEAR(found.reach_px, expected.reach_px, kRounding_px);
    EXPECT_EQ(found.found, expected.found);
  }

  /// Takes out one of so many events, evenly over each pixel's; 0: none.
  std::size_t lost_one_of_ = 0;
  FittedMotion fitted_;
  std::vector<float> log_image_;
  std::vector<float> mean_counts_;
  EventChanges changes_;
  float contrast_ = 0.0F;
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

TEST_F(MotionFitTest, IsTheOneOfASlowReference) {
  fit(testing::movingPlane(MotionKind::kSpin, 1.0));
  expectTheSlowFit();
  contrast_ = 0.05F;  // taken for 0.1
  expectTheSlowFit();
  fit(testing::movingPlane(MotionKind::kShake, 3.0));  // much leaves the image
  expectTheSlowFit();
  fit(testing::movingPlane(MotionKind::kSpin, 0.5));  // a smaller share would explain too little
  ASSERT_EQ(fitted_.event_share, 1.0F);
  expectTheSlowFit();
  fit(testing::movingPlane(MotionKind::kShake, 2.0));  // the smallest share that is used
  ASSERT_LT(fitted_.event_share, 0.8F);
  expectTheSlowFit();
  addNoise(0.3F);  // which makes it smaller
  ASSERT_EQ(fit().event_share, 1.0F);
  expectTheSlowFit();
  lost_one_of_ = 5;
  fit(testing::movingPlane(MotionKind::kShake, 0.3));
  ASSERT_LT(fitted_.event_share, 0.9F);
  expectTheSlowFit();
}

TEST_F(MotionFitTest, NeedsSixtyPixelsWithEvents) {
  fit(testing::movingPlane(MotionKind::kSpin, 1.0));
  const std::vector<float> all = mean_counts_;
  for (const int count : {59, 60}) {
    int left = count;
    for (std::size_t i = 0; i < all.size(); ++i) {
      const std::size_t x = i % kPlaneSize.width;
      const bool is_inside =
          x > 0 && x + 1 < std::size_t{kPlaneSize.width} && i >= std::size_t{kPlaneSize.width};
      const bool is_kept = is_inside && all[i] >= 2.0F && left > 0;
      left -= is_kept ? 1 : 0;
      mean_counts_[i] = is_kept ? 1.5F : 1.49F;
    }
    EXPECT_EQ(fit().found, count == 60) << count;
    expectTheSlowFit();
  }
}

TEST_F(MotionFitTest, FindsNothingWhereNothingMoves) {
  fit(testing::movingPlane(MotionKind::kStill, 1.0));
  EXPECT_FALSE(fitted_.found);
  EXPECT_EQ(fitted_.path_px, 0.0F);
  EXPECT_EQ(fitted_.event_share, 1.0F);
}

}  // namespace
}  // namespace fast_edi
