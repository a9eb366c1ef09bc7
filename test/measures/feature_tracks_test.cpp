#include "measures/feature_tracks.hpp"

#include <stdexcept>

#include <gmock/gmock.h>
#include <opencv2/imgproc.hpp>

namespace fast_edi {
namespace {

constexpr int kWidth = 240;
constexpr int kHeight = 180;

/// A plane of random squares, seen from (x, y).
cv::Mat view(double x, double y) {
  constexpr int kSide = 600;
  constexpr int kSquares = 400;
  cv::RNG random(5);
  cv::Mat1b plane(kSide, kSide, std::uint8_t{90});
  for (int i = 0; i < kSquares; ++i) {
    const cv::Rect square(random.uniform(0, kSide), random.uniform(0, kSide), 12, 9);
    cv::rectangle(plane, square, cv::Scalar(random.uniform(0, 255)), cv::FILLED);
  }
  cv::Mat image;
  cv::getRectSubPix(plane, {kWidth, kHeight},
                    cv::Point2f(static_cast<float>(300.0 + x), static_cast<float>(300.0 + y)),
                    image);
  return image;
}

cv::Mat noise(cv::RNG& random) {
  cv::Mat image(kHeight, kWidth, CV_8UC1);
  random.fill(image, cv::RNG::UNIFORM, 0, 255);
  return image;
}

TEST(FeatureTrackerTest, KeepsTheCornersOfAMovingPlane) {
  FeatureTracker tracker({150, 10.0});
  EXPECT_FALSE(tracker.track(view(0.0, 0.0)).has_value());
  TrackFigures figures;
  for (int frame = 1; frame <= 4; ++frame) {
    const auto found = tracker.track(view(3.0 * frame, -2.0 * frame));
    ASSERT_TRUE(found.has_value());
    figures = *found;
    EXPECT_GT(figures.tracks, 45) << "frame " << frame;
    EXPECT_GT(figures.moved_share.value(), 0.95);
  }
  // A track of the first frame is seen for the fifth time; those at the border are younger.
  EXPECT_GT(figures.mean_age, 3.5);
  EXPECT_LE(figures.mean_age, 5.0);
}

TEST(FeatureTrackerTest, WiderSpacingGivesFewer) {
  FeatureTracker close({150, 10.0});
  FeatureTracker wide({150, 20.0});
  for (FeatureTracker* tracker : {&close, &wide}) tracker->track(view(0.0, 0.0));
  const int many = close.track(view(2.0, 1.0)).value().tracks;
  const int few = wide.track(view(2.0, 1.0)).value().tracks;
  EXPECT_GT(few, 20);
  EXPECT_GT(many, few);
  EXPECT_LE(many, 150);
}

TEST(FeatureTrackerTest, NoiseIsNotTracked) {
  FeatureTracker tracker({150, 10.0});
  cv::RNG random(5);
  tracker.track(noise(random));
  EXPECT_LT(tracker.track(noise(random)).value().tracks, 15);
}

TEST(FeatureTrackerTest, WhatStandsStillDoesNotMoveWithTheScene) {
  FeatureTracker tracker({150, 10.0});
  // A third of the picture is dirt on the sensor: the scene moves behind it.
  const auto withDirt = [](double x) {
    cv::Mat image = view(x, 0.0);
    const cv::Rect dirt(0, 0, kWidth / 3, kHeight);
    view(150.0, 90.0)(dirt).copyTo(image(dirt));
    return image;
  };
  tracker.track(withDirt(0.0));
  const TrackFigures figures = tracker.track(withDirt(5.0)).value();
  EXPECT_GT(figures.tracks, 50);
  EXPECT_GT(figures.moved_share.value(), 0.4);
  EXPECT_LT(figures.moved_share.value(), 0.9);
}

TEST(FeatureTrackerTest, AfterClearTheNextImageIsAFirstOne) {
  FeatureTracker tracker({150, 10.0});
  tracker.track(view(0.0, 0.0));
  tracker.clear();
  EXPECT_FALSE(tracker.track(view(1.0, 0.0)).has_value());
}

TEST(FeatureTrackerTest, AnEmptySceneHasNoTracks) {
  FeatureTracker tracker({150, 10.0});
  const cv::Mat flat(kHeight, kWidth, CV_8UC1, cv::Scalar(80));
  tracker.track(flat);
  const TrackFigures figures = tracker.track(flat).value();
  EXPECT_EQ(figures.tracks, 0);
  EXPECT_EQ(figures.mean_age, 0.0);
  EXPECT_FALSE(figures.moved_share.has_value());
}

TEST(FeatureTrackerTest, RefusesColour) {
  FeatureTracker tracker({150, 10.0});
  EXPECT_THROW(tracker.track(cv::Mat(kHeight, kWidth, CV_8UC3)), std::invalid_argument);
}

}  // namespace
}  // namespace fast_edi
