// Samples taken out of a recording.
#include "survey/timing_sample.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "support/event_generators.hpp"

namespace fast_edi {
namespace {

SampledFrame frame(std::int64_t stamp_ns) {
  SampledFrame result;
  result.stamp_ns = stamp_ns;
  return result;
}

TEST(TimingSamplerTest, TakesTheFramesAndEventsAskedFor) {
  constexpr SensorSize kSize{4, 2};
  TimingSampler sampler(kSize, {{1, {1'000, 3'000}}, {5, {0, 9'000}}});
  const std::vector<std::uint8_t> wire = testing::toWire(
      {{0, 0, 0, true}, {1, 1, 1'000, true}, {2, 1, 2'000, false}, {3, 1, 3'000, true}});
  sampler.addEvents(testing::wireView(wire), kSize);
  sampler.addEvents(testing::wireView(wire), {8, 8});  // of another sensor
  const std::vector<std::uint8_t> pixels = {0, 100, 200, 255, 12, 243, 11, 244};
  ImageView image;
  image.data = pixels.data();
  image.size = kSize;
  image.step = 4;
  for (std::size_t i = 0; i < 4; ++i) {
    sampler.addFrame(i, frame(static_cast<std::int64_t>(i)), image);
  }
  const std::vector<TimingSample> samples = sampler.take();
  ASSERT_EQ(samples.size(), 1U);  // the other one's frames never came
  EXPECT_EQ(samples[0].first.stamp_ns, 1);
  EXPECT_EQ(samples[0].second.stamp_ns, 2);
  EXPECT_EQ(samples[0].events->eventCount(), 2U);
  const std::vector<float>& levels = samples[0].first.log_exposure;
  ASSERT_EQ(levels.size(), 8U);
  EXPECT_FLOAT_EQ(levels[1], std::log(100.0F));
  EXPECT_TRUE(std::isnan(levels[0]));
  EXPECT_TRUE(std::isnan(levels[3]));
  EXPECT_FALSE(std::isnan(levels[4]));
  EXPECT_FALSE(std::isnan(levels[5]));
  EXPECT_TRUE(std::isnan(levels[6]));
  EXPECT_TRUE(std::isnan(levels[7]));
}

TEST(TimingSamplerTest, LeavesOutRowsOfLargeSensors) {
  constexpr SensorSize kSize{346, 260};
  TimingSampler sampler(kSize, {{0, {0, 10'000}}});
  EXPECT_EQ(sampler.grid().size(), (SensorSize{346, 65}));
  const std::vector<std::uint8_t> wire =
      testing::toWire({{7, 3, 1'000, true}, {7, 4, 2'000, true}});
  sampler.addEvents(testing::wireView(wire), kSize);
  const std::vector<std::uint8_t> pixels(kSize.pixelCount(), 50);
  ImageView image;
  image.data = pixels.data();
  image.size = kSize;
  image.step = 346;
  sampler.addFrame(0, frame(0), image);
  sampler.addFrame(1, frame(1), image);
  const std::vector<TimingSample> samples = sampler.take();
  ASSERT_EQ(samples.size(), 1U);
  ASSERT_EQ(samples[0].events->eventCount(), 1U);
  EXPECT_EQ(samples[0].events->span(0, 1).data[0].code >> 1, 346U + 7U);
  EXPECT_EQ(samples[0].first.log_exposure.size(), 346U * 65U);
}

std::vector<TimingSample> samplesOf(std::uint8_t darkest, std::uint8_t brightest, int at_ends) {
  std::vector<TimingSample> samples(2);
  for (TimingSample& sample : samples) {
    for (SampledFrame* frame : {&sample.first, &sample.second}) {
      frame->levels.assign(10'000, 100);
      std::fill_n(frame->levels.begin(), at_ends, darkest);
      std::fill_n(frame->levels.begin() + at_ends, at_ends, brightest);
    }
  }
  return samples;
}

TEST(TimingSampleTest, StretchedFramesUseAllLevelsWithFewPixelsAtTheEnds) {
  EXPECT_TRUE(areStretched(samplesOf(0, 255, 3)));
  EXPECT_FALSE(areStretched(samplesOf(4, 255, 3)));
  EXPECT_FALSE(areStretched(samplesOf(0, 250, 3)));
  EXPECT_FALSE(areStretched(samplesOf(0, 255, 300)));  // saturated, as sensors are
  EXPECT_FALSE(areStretched({}));
}

}  // namespace
}  // namespace fast_edi
