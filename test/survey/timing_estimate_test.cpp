// The estimate where there is nothing to estimate; recording_validator_test.cpp has simulations.
#include "survey/timing_estimate.hpp"

#include <random>
#include <vector>

#include <gmock/gmock.h>

namespace fast_edi {
namespace {

using ::testing::HasSubstr;

constexpr SensorSize kSize{40, 30};
constexpr std::int64_t kMs = kNanosecondsPerMillisecond;

/// Frames and events that have nothing to do with each other.
TimingSample noise(unsigned seed) {
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
    readExposure(*frame, SampleGrid{kSize, 1}, EventOrientation::kNormal);
  }
  return sample;
}

TEST(TimingEstimateTest, NoiseTellsNothing) {
  std::vector<TimingSample> samples;
  for (unsigned seed = 1; seed <= 4; ++seed) {
    samples.push_back(noise(seed));
  }
  TimingSearch search;
  search.range_ns = 50 * kMs;
  const TimingEstimate estimate = estimateTiming(samples, SampleGrid{kSize, 1}, search);
  EXPECT_FALSE(estimate.told);
  EXPECT_THAT(estimate.reason, HasSubstr("do not fit together"));
}

TEST(TimingEstimateTest, OnePairIsNotEnough) {
  std::vector<TimingSample> samples;
  samples.push_back(noise(1));
  const TimingEstimate estimate = estimateTiming(samples, SampleGrid{kSize, 1}, TimingSearch{});
  EXPECT_FALSE(estimate.told);
  EXPECT_THAT(estimate.reason, HasSubstr("fewer than two pairs"));
}

}  // namespace
}  // namespace fast_edi
