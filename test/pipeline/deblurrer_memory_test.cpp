// What the pipeline says of its memory, beside what it has allocated.

#include "fast_edi/pipeline/deblurrer.hpp"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "reblur/moving_plane.hpp"
#include "support/allocation_counter.hpp"
#include "support/event_generators.hpp"
#include "support/pipeline_input.hpp"

namespace fast_edi {
namespace {

constexpr std::int64_t kMs = kNanosecondsPerMillisecond;
constexpr SensorSize kSize{160, 120};
constexpr int kFrames = 6;

/// Memory for one image at a time.
class OneImageSink : public FrameSink {
 public:
  MutableImageView begin(const InputFrame& input) override { return view(input); }
  void finish(const OutputFrame&) override {}
  bool wantsLatentImages() const override { return true; }
  MutableImageView beginLatent(const InputFrame& input) override { return view(input); }

 private:
  MutableImageView view(const InputFrame& input) {
    return {pixels_.data(), input.image.size, static_cast<std::size_t>(input.image.size.width),
            PixelFormat::kMono8};
  }
  std::vector<std::uint8_t> pixels_ = std::vector<std::uint8_t>(kSize.pixelCount());
};

struct Case {
  std::string name;
  DeblurParameters parameters;
};

std::vector<Case> cases() {
  DeblurParameters plain;
  plain.thresholds = {0.3, 0.3};
  plain.exposure_source = ExposureSource::kParameter;
  plain.exposure_time_ns = 30 * kMs;
  plain.filter.enabled = false;
  plain.refine_contrast = plain.refine_delay = false;
  DeblurParameters filters = plain;
  filters.filter.enabled = true;
  DeblurParameters learning = filters;
  learning.refine_contrast = learning.refine_delay = true;
  DeblurParameters fusion = filters;
  fusion.filter.temporal = 0.3;
  DeblurParameters motion = filters;
  motion.reference = ExposureInstant::kStart;
  DeblurParameters video = filters;
  video.latent.per_exposure = 3;
  DeblurParameters all = motion;
  all.refine_contrast = all.refine_delay = true;
  all.filter.temporal = 0.3;
  all.latent.per_exposure = 3;
  return {{"plain", plain},   {"filters", filters}, {"learning", learning},
          {"fusion", fusion}, {"motion", motion},   {"video", video},
          {"all", all}};
}

/// Less by small things, which grow with neither pixels nor events, and by what malloc rounds up.
void expectAllocated(const Deblurrer& deblurrer, std::int64_t bytes) {
  constexpr std::int64_t kSmallThings = 65536;
  const auto said = static_cast<std::int64_t>(deblurrer.status().buffer_bytes);
  EXPECT_LE(said, bytes);
  EXPECT_GE(said, bytes - kSmallThings);
}

TEST(DeblurrerMemory, IsWhatStatusSays) {
  for (const Case& c : cases()) {
    OneImageSink sink;
    const std::int64_t before = testing::allocatedBytes();
    Deblurrer deblurrer(c.parameters, sink);
    for (int i = 0; i < kFrames; ++i) {
      const std::int64_t t_ns = kNanosecondsPerSecond + i * 40 * kMs;
      const auto records = testing::toWire(
          testing::makeEvents(testing::EventScene::kMovingEdges,
                              {kSize, 20'000, t_ns, 40 * kMs, static_cast<std::uint64_t>(i + 1)}));
      deblurrer.addEvents(testing::wireView(records), kSize, static_cast<std::uint32_t>(i),
                          i * 40 * kMs);
      deblurrer.addFrame(
          testing::makeFrame(t_ns + 20 * kMs, kSize, testing::makeGreyImage(kSize, 3)),
          i * 40 * kMs);
    }
    ASSERT_EQ(deblurrer.counters().frames_deblurred, std::uint64_t{kFrames}) << c.name;
    SCOPED_TRACE(c.name);
    expectAllocated(deblurrer, testing::allocatedBytes() - before);
  }
}

TEST(DeblurrerMemory, OfReblurringIsWhatStatusSays) {
  const SimulationSettings settings = testing::movingPlane(MotionKind::kShake, 1.0);
  const SimulatedSequence sequence = simulateSequence(settings);
  DeblurParameters parameters;
  parameters.thresholds = {settings.sensor.thresholds.on, settings.sensor.thresholds.off};
  parameters.exposure_source = ExposureSource::kParameter;
  parameters.exposure_time_ns = settings.timing.exposure_us * kNanosecondsPerMicrosecond;
  std::vector<std::int64_t> bytes;
  for (const bool reblur : {false, true}) {
    parameters.filter.reblur = reblur;
    OneImageSink sink;
    const std::int64_t before = testing::allocatedBytes();
    Deblurrer deblurrer(parameters, sink);
    deblurrer.addEvents(sequence.events.data(), sequence.events.size(), testing::kPlaneSize, 0);
    for (const SimulatedFrame& frame : sequence.frames) {
      deblurrer.addFrame(
          testing::makeFrame(frame.exposure.at(ExposureInstant::kMid), testing::kPlaneSize,
                             {frame.blurry.datastart, frame.blurry.dataend}),
          0);
    }
    SCOPED_TRACE(reblur);
    bytes.push_back(testing::allocatedBytes() - before);
    expectAllocated(deblurrer, bytes.back());
  }
  EXPECT_GT(bytes.back(), bytes.front() + 1'000'000) << "nothing was re-blurred";
}

}  // namespace
}  // namespace fast_edi
