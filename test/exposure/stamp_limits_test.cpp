/// Frames at the ends of the time that ROS stamps can tell.
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "fast_edi/exposure/stamp_limits.hpp"
#include "fast_edi/pipeline/deblurrer.hpp"
#include "support/event_generators.hpp"
#include "support/pipeline_input.hpp"

namespace fast_edi {
namespace {

constexpr std::int64_t kMs = kNanosecondsPerMillisecond;
constexpr SensorSize kSize{4, 4};

/// Puts a frame of 20 ms exposure in the middle of an event stream.
testing::RecordingSink deblurOne(std::int64_t stamp_ns, ExposureInstant stamp_reference,
                                 ExposureInstant reference) {
  DeblurParameters parameters;
  parameters.thresholds = {0.3, 0.3};
  parameters.exposure_source = ExposureSource::kParameter;
  parameters.exposure_time_ns = 20 * kMs;
  parameters.stamp_reference = stamp_reference;
  parameters.reference = reference;
  parameters.latent.per_exposure = 4;
  parameters.time_offset_ns = stamp_ns < 100 * kMs ? 100 * kMs : -100 * kMs;
  testing::RecordingSink sink;
  sink.wants_latent_images = true;
  Deblurrer deblurrer(parameters, sink);
  std::vector<Event> events;
  for (std::int64_t i = -50; i <= 50; ++i) {
    events.push_back({1, 1, stamp_ns + parameters.time_offset_ns + i * kMs, i % 2 == 0});
  }
  const std::vector<std::uint8_t> bytes = testing::toWire(events);
  deblurrer.addEvents(testing::wireView(bytes), kSize, 1, 0);
  deblurrer.addFrame(testing::makeFlatFrame(stamp_ns, kSize), 1);
  deblurrer.finish();
  return sink;
}

TEST(StampLimits, AFrameThatBeginsBeforeTimeIsStampedZero) {
  const testing::RecordingSink sink =
      deblurOne(5 * kMs, ExposureInstant::kMid, ExposureInstant::kStart);
  ASSERT_EQ(sink.outputs.size(), 1u);
  EXPECT_TRUE(sink.outputs[0].frame.deblurred);
  EXPECT_EQ(sink.outputs[0].frame.stamp_ns, 0);
  EXPECT_EQ(sink.outputs[0].frame.exposure.start_ns, -5 * kMs);
  // Of four instants in [-5, 15) ms the first lies before time.
  ASSERT_EQ(sink.latent_images.size(), 3u);
  EXPECT_EQ(sink.latent_images[0].stamp_ns, 2'500'000);
}

TEST(StampLimits, AFrameThatEndsAfterTimeHasTheLastStamp) {
  const testing::RecordingSink sink =
      deblurOne(kLastStamp_ns - 5 * kMs, ExposureInstant::kMid, ExposureInstant::kEnd);
  ASSERT_EQ(sink.outputs.size(), 1u);
  EXPECT_TRUE(sink.outputs[0].frame.deblurred);
  EXPECT_EQ(sink.outputs[0].frame.stamp_ns, kLastStamp_ns);
  for (const testing::RecordedLatent& latent : sink.latent_images) {
    EXPECT_LE(latent.stamp_ns, kLastStamp_ns);
  }
}

}  // namespace
}  // namespace fast_edi
