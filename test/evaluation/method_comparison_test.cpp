#include "evaluation/method_comparison.hpp"

#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include <gmock/gmock.h>

#include "evaluation/test_images.hpp"

namespace fast_edi {
namespace {

constexpr SensorSize kSize{32, 24};
constexpr std::int64_t kMs = kNanosecondsPerMillisecond;
constexpr std::int64_t kExposureNs = 10 * kMs;

DeblurParameters parameters() {
  DeblurParameters result;
  result.thresholds = {0.3, 0.2};
  result.exposure_source = ExposureSource::kParameter;
  result.exposure_time_ns = kExposureNs;
  result.filter.enabled = false;
  return result;
}

class MethodComparisonTest : public testing::Test {
 protected:
  void addEvents(const std::vector<Event>& events, SensorSize size = kSize) {
    std::vector<std::uint8_t> bytes;
    for (const Event& event : events) {
      encodeWireEvent(event, bytes);
    }
    comparison_.addEvents({bytes.data(), events.size()}, size, sequence_++, ++now_ns_);
  }
  void addFrame(std::int64_t stamp_ns, const cv::Mat& image) {
    comparison_.addFrame(stamp_ns, image, ++now_ns_);
  }

  std::vector<ComparedFrame> frames_;
  MethodComparison comparison_{
      parameters(), {}, [this](const ComparedFrame& frame) { frames_.push_back(frame); }};
  std::uint32_t sequence_ = 0;
  std::int64_t now_ns_ = 0;
  cv::Mat grey_{kSize.height, kSize.width, CV_8UC1, cv::Scalar(100)};
};

TEST_F(MethodComparisonTest, EachMethodShowsItsOwnEquation) {
  // One ON event after 8 of 10 ms, at a pixel of its own; others make the counter run.
  const std::int64_t start = 1000 * kMs;
  addEvents({{9, 9, start - 50 * kMs, true}});
  addEvents({{5, 6, start + 1 * kMs, true},
             {9, 1, start + 2 * kMs, false},
             {9, 2, start + 3 * kMs, false},
             {7, 8, start + 8 * kMs, true}});
  addFrame(start + 5 * kMs, grey_);
  addEvents({{9, 9, start + 20 * kMs, true}});
  ASSERT_EQ(frames_.size(), 1U);
  const ComparedFrame& frame = frames_[0];
  ASSERT_TRUE(frame.compared);
  EXPECT_EQ(frame.events, 4U);
  EXPECT_EQ(frame.exposure.start_ns, start);
  EXPECT_EQ(frame.exposure.length(), kExposureNs);
  const auto at = [&](Method method, int x, int y) {
    return int{frame.images[indexOf(method)].at<std::uint8_t>(y, x)};
  };
  const double m = std::exp(0.3);
  EXPECT_EQ(at(Method::kBlurry, 5, 6), 100);
  // Time: level 1 for 1 ms, m for 9 ms; the reference lies after the event.
  EXPECT_NEAR(at(Method::kPlain, 5, 6), 100.0 * m / (0.1 + 0.9 * m), 0.51);
  EXPECT_NEAR(at(Method::kPlain, 7, 8), 100.0 / (0.8 + 0.2 * m), 0.51);
  // Counter: the event at (7, 8) is the fourth of four.
  EXPECT_NEAR(at(Method::kCounter, 7, 8), 100.0 / (0.75 + 0.25 * m), 0.51);
  EXPECT_EQ(at(Method::kPlain, 0, 0), 100);
  EXPECT_EQ(cv::norm(frame.images[indexOf(Method::kOurs)], frame.images[indexOf(Method::kPlain)],
                     cv::NORM_INF),
            0.0);
  const double searched = std::exp(frame.searched_contrast);
  EXPECT_NEAR(at(Method::kSearched, 7, 8), 100.0 / (0.8 + 0.2 * searched), 0.51);
  EXPECT_TRUE(frame.images[indexOf(Method::kTruth)].empty());
}

TEST_F(MethodComparisonTest, PassedThroughFramesComeWithTheirReason) {
  addFrame(100 * kMs, grey_);
  comparison_.finish();
  ASSERT_EQ(frames_.size(), 1U);
  EXPECT_FALSE(frames_[0].compared);
  EXPECT_EQ(frames_[0].pass_reason, PassReason::kNoEventStream);
  EXPECT_EQ(comparison_.counters().framesPassed(), 1U);
}

TEST_F(MethodComparisonTest, AnUnsupportedFrameIsPassedThrough) {
  addEvents({{1, 1, 10 * kMs, true}});
  addFrame(100 * kMs, cv::Mat());
  addEvents({{1, 1, 200 * kMs, true}});
  comparison_.finish();
  ASSERT_EQ(frames_.size(), 1U);
  EXPECT_FALSE(frames_[0].compared);
  EXPECT_EQ(frames_[0].pass_reason, PassReason::kUnsupportedEncoding);
}

TEST_F(MethodComparisonTest, AFrameOfAnotherSizeIsPassedThrough) {
  addEvents({{1, 1, 10 * kMs, true}});
  addFrame(100 * kMs, cv::Mat(kSize.height + 8, kSize.width, CV_8UC1, cv::Scalar(5)));
  addEvents({{1, 1, 200 * kMs, true}});
  comparison_.finish();
  ASSERT_EQ(frames_.size(), 1U);
  EXPECT_FALSE(frames_[0].compared);
  EXPECT_EQ(frames_[0].pass_reason, PassReason::kSizeMismatch);
}

TEST_F(MethodComparisonTest, RefusesColour) {
  EXPECT_THROW(addFrame(100 * kMs, cv::Mat(kSize.height, kSize.width, CV_8UC3)),
               std::invalid_argument);
}

TEST_F(MethodComparisonTest, ErrorsOfTheReceiverReachTheCaller) {
  MethodComparison failing(parameters(), {},
                           [](const ComparedFrame&) { throw std::runtime_error("disk full"); });
  failing.addFrame(100 * kMs, grey_, 0);
  EXPECT_THROW(failing.finish(), std::runtime_error);
}

TEST(ParametersOfTest, OnlyOursIsFilteredAndAllShowTheSameInstant) {
  DeblurParameters ours = parameters();
  ours.filter.enabled = true;
  ours.reference = ExposureInstant::kStart;
  EXPECT_EQ(parametersOf(Method::kCounter, ours).weighting, Weighting::kCounter);
  EXPECT_EQ(parametersOf(Method::kPlain, ours).weighting, Weighting::kTime);
  EXPECT_FALSE(parametersOf(Method::kCounter, ours).filter.enabled);
  EXPECT_FALSE(parametersOf(Method::kPlain, ours).filter.enabled);
  EXPECT_TRUE(parametersOf(Method::kOurs, ours).filter.enabled);
  for (const Method method : {Method::kPlain, Method::kCounter, Method::kOurs}) {
    EXPECT_EQ(parametersOf(method, ours).reference, ExposureInstant::kStart);
    EXPECT_EQ(parametersOf(method, ours).thresholds, ours.thresholds);
  }
}

}  // namespace
}  // namespace fast_edi
