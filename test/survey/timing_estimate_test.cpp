// The estimate where there is nothing to estimate; recording_validator_test.cpp has simulations.
#include "survey/timing_estimate.hpp"

#include <vector>

#include <gmock/gmock.h>

#include "survey/unrelated_sample.hpp"

namespace fast_edi {
namespace {

using ::testing::HasSubstr;

constexpr SensorSize kSize{40, 30};
constexpr std::int64_t kMs = kNanosecondsPerMillisecond;

TEST(TimingEstimateTest, NoiseTellsNothing) {
  std::vector<TimingSample> samples;
  for (unsigned seed = 1; seed <= 4; ++seed) {
    samples.push_back(testing::unrelatedSample(seed));
  }
  TimingSearch search;
  search.range_ns = 50 * kMs;
  const TimingEstimate estimate = estimateTiming(samples, SampleGrid{kSize, 1}, search);
  EXPECT_FALSE(estimate.told);
  EXPECT_THAT(estimate.reason, HasSubstr("do not fit together"));
}

TEST(TimingEstimateTest, OnePairIsNotEnough) {
  std::vector<TimingSample> samples;
  samples.push_back(testing::unrelatedSample(1));
  const TimingEstimate estimate = estimateTiming(samples, SampleGrid{kSize, 1}, TimingSearch{});
  EXPECT_FALSE(estimate.told);
  EXPECT_THAT(estimate.reason, HasSubstr("fewer than two pairs"));
}

}  // namespace
}  // namespace fast_edi
