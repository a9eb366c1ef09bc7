// The wide search where there is nothing to find; recording_validator_test.cpp has simulations of
// each orientation.
#include "survey/coarse_match.hpp"

#include <vector>

#include <gtest/gtest.h>

#include "survey/unrelated_sample.hpp"

namespace fast_edi {
namespace {

constexpr SensorSize kSize{40, 30};
constexpr std::int64_t kMs = kNanosecondsPerMillisecond;

TEST(CoarseMatchTest, WhatFitsNowhereIsLeftAsItWas) {
  std::vector<TimingSample> samples;
  for (unsigned seed = 1; seed <= 3; ++seed) {
    samples.push_back(testing::unrelatedSample(seed));
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
