// The wide search where there is nothing to find; recording_validator_test.cpp has simulations of
// each orientation.
#include "survey/coarse_match.hpp"

#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace fast_edi {
namespace {

constexpr SensorSize kSize{40, 30};
constexpr std::int64_t kMs = kNanosecondsPerMillisecond;

TimingSample unrelated(unsigned seed) {
  std::mt19937 random(seed);
  TimingSample sample;
  sample.events = std::make_unique<PixelEventLists>(kSize, PixelEventLists::Limits{});
  sample.events->keepIntervals(true);
  for (std::int64_t t_ns = 0; t_ns < 300 * kMs; t_ns += 20'000) {
    sample.events->append(Event{static_cast<std::uint16_t>(random() % 40),
                                static_cast<std::uint16_t>(random() % 30), t_ns,
                                random() % 2 == 0});
  }
  std::int64_t stamp_ns = 130 * kMs;
  for (SampledFrame* frame : {&sample.first, &sample.second}) {
    frame->stamp_ns = stamp_ns;
    frame->length_ns = 20 * kMs;
    stamp_ns += 40 * kMs;
    for (std::size_t i = 0; i < kSize.pixelCount(); ++i) {
      frame->levels.push_back(static_cast<std::uint8_t>(50 + random() % 100));
    }
    frame->size = kSize;
    readExposure(*frame, {kSize, 1}, EventOrientation::kNormal);
  }
  return sample;
}

TEST(CoarseMatchTest, WhatFitsNowhereIsLeftAsItWas) {
  std::vector<TimingSample> samples;
  for (unsigned seed = 1; seed <= 3; ++seed) {
    samples.push_back(unrelated(seed));
  }
  const std::vector<float> before = samples[0].first.log_exposure;
  PairConsistency consistency(kSize);
  const CoarseMatch match = matchOrientations(samples, {kSize, 1}, {}, {0.25, 0.25},
                                              {0.0, 50.0 * kMs, 5.0 * kMs}, consistency);
  EXPECT_FALSE(match.fits());
  EXPECT_TRUE(match.mapping.isIdentity());
  EXPECT_EQ(match.curve.size(), 21u);
  EXPECT_EQ(samples[0].first.log_exposure, before);
}

}  // namespace
}  // namespace fast_edi
