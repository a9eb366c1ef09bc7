#include "fast_edi/exposure/window_predictor.hpp"

#include <gtest/gtest.h>

namespace fast_edi {
namespace {

constexpr std::int64_t kMs = kNanosecondsPerMillisecond;

ExposureInterval exposureAt(std::int64_t start_ns, std::int64_t length_ns = 10 * kMs) {
  return {start_ns, start_ns + length_ns};
}

TEST(WindowPredictor, OneExposureHasNoPeriod) {
  WindowPredictor predictor;
  EXPECT_FALSE(predictor.predict());
  EXPECT_EQ(predictor.lastLength(), 0);
  predictor.observe(exposureAt(0));
  EXPECT_FALSE(predictor.predict());
  EXPECT_EQ(predictor.lastLength(), 10 * kMs);
}

TEST(WindowPredictor, PredictsTheNextStartWithTheLastLength) {
  WindowPredictor predictor;
  predictor.observe(exposureAt(0));
  predictor.observe(exposureAt(40 * kMs, 12 * kMs));
  ASSERT_TRUE(predictor.predict());
  EXPECT_EQ(*predictor.predict(), exposureAt(80 * kMs, 12 * kMs));
}

TEST(WindowPredictor, ALostFrameDoesNotSpoilThePredictionsAfterIt) {
  WindowPredictor predictor;
  for (std::int64_t start_ms : {0, 40, 80, 160}) {
    predictor.observe(exposureAt(start_ms * kMs));
  }
  EXPECT_EQ(*predictor.predict(), exposureAt(200 * kMs));
}

TEST(WindowPredictor, FollowsANewFrameRate) {
  WindowPredictor predictor;
  for (std::int64_t start_ms : {0, 40, 80, 120, 140, 160}) {
    predictor.observe(exposureAt(start_ms * kMs));
  }
  EXPECT_EQ(*predictor.predict(), exposureAt(180 * kMs));
}

TEST(WindowPredictor, APauseOrAStepBackIsNoPeriod) {
  WindowPredictor predictor;
  predictor.observe(exposureAt(0));
  predictor.observe(exposureAt(40 * kMs));
  predictor.observe(exposureAt(40 * kMs + WindowPredictor::kMaxPeriod_ns + 1));
  EXPECT_FALSE(predictor.predict());
  predictor.observe(exposureAt(0));
  EXPECT_FALSE(predictor.predict());
  predictor.observe(exposureAt(30 * kMs));
  EXPECT_EQ(*predictor.predict(), exposureAt(60 * kMs));
}

TEST(WindowPredictor, ResetForgetsAll) {
  WindowPredictor predictor;
  predictor.observe(exposureAt(0));
  predictor.observe(exposureAt(40 * kMs));
  predictor.reset();
  EXPECT_FALSE(predictor.predict());
  EXPECT_EQ(predictor.lastLength(), 0);
}

}  // namespace
}  // namespace fast_edi
