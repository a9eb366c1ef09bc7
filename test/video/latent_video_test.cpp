// The high-rate video of a Deblurrer.
#include "fast_edi/video/latent_video.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <vector>

#include <gmock/gmock.h>

#include "fast_edi/pipeline/deblurrer.hpp"
#include "support/event_generators.hpp"
#include "support/pipeline_input.hpp"
#include "support/reference_double_integral.hpp"

namespace fast_edi {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::Le;

constexpr std::int64_t kMs = kNanosecondsPerMillisecond;
constexpr SensorSize kSize{16, 12};
constexpr std::int64_t kZero = 1000 * kNanosecondsPerSecond;

/// Times in milliseconds after kZero. Exposures of 20 ms around the stamp.
class LatentVideoTest : public ::testing::Test {
 protected:
  LatentVideoTest() {
    parameters.thresholds = {0.3, 0.25};
    parameters.exposure_source = ExposureSource::kParameter;
    parameters.exposure_time_ns = 20 * kMs;
    parameters.filter.enabled = false;
    parameters.latent.per_exposure = 4;
    sink.wants_latent_images = true;
  }

  Deblurrer& pipeline() {
    if (!pipeline_) {
      pipeline_ = std::make_unique<Deblurrer>(parameters, sink);
    }
    return *pipeline_;
  }

  void events(std::int64_t from_ms, std::int64_t to_ms) {
    const auto length_ms = static_cast<std::size_t>(to_ms - from_ms);
    const auto list = testing::makeEvents(
        testing::EventScene::kUniform,
        {kSize, 20 * length_ms, kZero + from_ms * kMs, (to_ms - from_ms) * kMs, ++sequence});
    all_events.insert(all_events.end(), list.begin(), list.end());
    pipeline().addEvents(testing::wireView(testing::toWire(list)), kSize, sequence, 0);
  }

  void frame(std::int64_t stamp_ms) {
    pipeline().addFrame(
        testing::makeFrame(kZero + stamp_ms * kMs, kSize, testing::makeGreyImage(kSize, 3)), 0);
  }

  std::vector<double> latentStamps_ms() const {
    std::vector<double> stamps;
    for (const auto& image : sink.latent_images) {
      stamps.push_back(static_cast<double>(image.stamp_ns - kZero) / static_cast<double>(kMs));
    }
    return stamps;
  }

  /// What the slow reference computes at an instant of an exposure.
  void expectReference(const testing::RecordedLatent& image) {
    const ExposureInterval window{image.source_ns - 10 * kMs + parameters.time_offset_ns,
                                  image.source_ns + 10 * kMs + parameters.time_offset_ns};
    const auto integral = testing::referenceDoubleIntegral(
        kSize, all_events, parameters.thresholds, parameters.weighting, window,
        image.stamp_ns + parameters.time_offset_ns);
    const std::vector<std::uint8_t> blurry = testing::makeGreyImage(kSize, 3);
    for (std::size_t pixel = 0; pixel < integral.size(); ++pixel) {
      const double expected = std::min(255.0, blurry[pixel] / integral[pixel]);
      ASSERT_NEAR(image.pixels[pixel], expected, 0.51) << "pixel " << pixel;
    }
  }

  DeblurParameters parameters;
  testing::RecordingSink sink;
  std::vector<Event> all_events;
  std::uint32_t sequence = 0;

 private:
  std::unique_ptr<Deblurrer> pipeline_;
};

TEST_F(LatentVideoTest, ShowsEachExposureAndTheGapBetween) {
  events(0, 100);
  frame(20);
  EXPECT_THAT(latentStamps_ms(), ElementsAre(12.5, 17.5, 22.5, 27.5));
  frame(50);
  EXPECT_THAT(latentStamps_ms(),
              ElementsAre(12.5, 17.5, 22.5, 27.5, 32.5, 37.5, 42.5, 47.5, 52.5, 57.5));
  EXPECT_EQ(pipeline().counters().latent_images, 10u);
  EXPECT_TRUE(sink.isBalanced());
}

TEST_F(LatentVideoTest, ShowsWhatTheReferenceComputesThere) {
  parameters.time_offset_ns = 3 * kMs;
  for (const Weighting weighting : {Weighting::kTime, Weighting::kCounter}) {
    parameters.weighting = weighting;
    pipeline().setParameters(parameters);
    const auto offset_ms = weighting == Weighting::kTime ? 0 : 200;
    events(offset_ms, offset_ms + 100);
    frame(offset_ms + 20);
    frame(offset_ms + 50);
  }
  ASSERT_EQ(sink.latent_images.size(), 20u);
  int within = 0;
  for (const auto& image : sink.latent_images) {
    if (std::abs(image.stamp_ns - image.source_ns) < 10 * kMs) {
      parameters.weighting =
          image.stamp_ns < kZero + 150 * kMs ? Weighting::kTime : Weighting::kCounter;
      expectReference(image);
      ++within;
    }
  }
  EXPECT_EQ(within, 16);
}

TEST_F(LatentVideoTest, ShowsAGapFromTheNearerFrame) {
  parameters.latent = {0, 500};
  events(0, 100);
  frame(20);
  frame(60);
  ASSERT_FALSE(sink.latent_images.empty());
  std::int64_t expected_ns = kZero + 10 * kMs;
  for (const auto& image : sink.latent_images) {
    EXPECT_EQ(image.stamp_ns, expected_ns);
    expected_ns += 2 * kMs;
    EXPECT_EQ(image.source_ns, kZero + (image.stamp_ns < kZero + 40 * kMs ? 20 : 60) * kMs);
  }
  EXPECT_EQ(expected_ns, kZero + 70 * kMs);
}

TEST_F(LatentVideoTest, CarriesAFrameAcrossTheGapByItsEvents) {
  parameters.latent = {0, 1000};
  events(0, 100);
  frame(20);
  frame(60);
  const std::vector<std::uint8_t> blurry = testing::makeGreyImage(kSize, 3);
  for (const auto& image : sink.latent_images) {
    const ExposureInterval window{image.source_ns - 10 * kMs, image.source_ns + 10 * kMs};
    const auto integral = testing::referenceDoubleIntegral(
        kSize, all_events, parameters.thresholds, Weighting::kTime, window, image.source_ns);
    std::vector<double> expected(blurry.begin(), blurry.end());
    for (std::size_t pixel = 0; pixel < expected.size(); ++pixel) {
      expected[pixel] /= integral[pixel];
    }
    for (const Event& event : all_events) {
      const std::size_t pixel = event.y * static_cast<std::size_t>(kSize.width) + event.x;
      const double step = parameters.thresholds.step(event.on);
      if (event.t_ns >= image.source_ns && event.t_ns < image.stamp_ns) {
        expected[pixel] *= std::exp(step);
      } else if (event.t_ns < image.source_ns && event.t_ns >= image.stamp_ns) {
        expected[pixel] *= std::exp(-step);
      }
    }
    for (std::size_t pixel = 0; pixel < expected.size(); ++pixel) {
      ASSERT_NEAR(image.pixels[pixel], std::min(255.0, expected[pixel]), 0.51);
    }
  }
}

TEST_F(LatentVideoTest, ComesBehindTheFrameItself) {
  events(0, 100);
  frame(20);
  frame(50);
  for (const auto& image : sink.latent_images) {
    EXPECT_EQ(image.frames, image.stamp_ns < kZero + 30 * kMs ? 1u : 2u);
  }
}

TEST_F(LatentVideoTest, AtTheReferenceTimeEqualsTheFrameEvenFiltered) {
  parameters.filter.enabled = true;
  parameters.latent.per_exposure = 1;
  events(0, 100);
  frame(20);
  ASSERT_EQ(sink.latent_images.size(), 1u);
  EXPECT_EQ(sink.latent_images[0].stamp_ns, sink.outputs.at(0).frame.stamp_ns);
  EXPECT_EQ(sink.latent_images[0].pixels, sink.outputs.at(0).pixels);
}

TEST_F(LatentVideoTest, LeavesTheFramesAsTheyWere) {
  parameters.filter.enabled = true;
  events(0, 100);
  frame(20);
  frame(50);
  testing::RecordingSink without;
  Deblurrer other(parameters, without);
  other.addEvents(testing::wireView(testing::toWire(all_events)), kSize, 1, 0);
  for (const std::int64_t stamp_ms : {20, 50}) {
    other.addFrame(
        testing::makeFrame(kZero + stamp_ms * kMs, kSize, testing::makeGreyImage(kSize, 3)), 0);
  }
  EXPECT_THAT(without.latent_images, IsEmpty());
  ASSERT_EQ(without.outputs.size(), sink.outputs.size());
  for (std::size_t i = 0; i < without.outputs.size(); ++i) {
    EXPECT_EQ(without.outputs[i].pixels, sink.outputs[i].pixels);
  }
}

TEST_F(LatentVideoTest, IsNotMadeUnlessWantedAndAskedFor) {
  events(0, 200);
  sink.wants_latent_images = false;
  frame(20);
  EXPECT_EQ(pipeline().counters().latent_images, 0u);
  sink.wants_latent_images = true;
  frame(50);  // nothing was kept of the frame before
  EXPECT_THAT(latentStamps_ms(), ElementsAre(42.5, 47.5, 52.5, 57.5));
  parameters.latent.per_exposure = 0;
  pipeline().setParameters(parameters);
  frame(80);
  EXPECT_EQ(sink.latent_images.size(), 4u);
}

TEST_F(LatentVideoTest, HasNothingFromFramesThatWerePassedThrough) {
  events(15, 200);
  frame(20);  // its first events are missing
  ASSERT_FALSE(sink.outputs.at(0).frame.deblurred);
  frame(50);
  EXPECT_THAT(latentStamps_ms(), ElementsAre(42.5, 47.5, 52.5, 57.5));
}

TEST_F(LatentVideoTest, BridgesNoHoleInTheEvents) {
  events(0, 20);
  events(20, 32);
  sequence += 5;  // tells of lost arrays
  events(38, 100);
  frame(20);
  frame(60);
  for (const double stamp : latentStamps_ms()) {
    EXPECT_TRUE(stamp < 30.0 || stamp >= 38.0) << stamp;
  }
  EXPECT_TRUE(sink.outputs.at(0).frame.deblurred);
  EXPECT_TRUE(sink.outputs.at(1).frame.deblurred);
  EXPECT_EQ(sink.latent_images.size(), 10u);
}

/// Exposures from 10 to 30 and 50 to 70 ms are of events 8 ms later; so are the halves of the gap
/// between them.
TEST_F(LatentVideoTest, LooksForHolesInTheTimeOfTheEvents) {
  parameters.time_offset_ns = 8 * kMs;
  const auto stampsWithHole = [this](std::int64_t from_ms) {
    pipeline().pause();
    sink.latent_images.clear();
    events(0, 20);
    events(20, from_ms);
    sequence += 5;
    events(from_ms + 6, 100);
    frame(20);
    frame(60);
    return latentStamps_ms();
  };
  EXPECT_THAT(stampsWithHole(40),
              ElementsAre(12.5, 17.5, 22.5, 27.5, 42.5, 47.5, 52.5, 57.5, 62.5, 67.5));
  EXPECT_THAT(stampsWithHole(50),
              ElementsAre(12.5, 17.5, 22.5, 27.5, 32.5, 37.5, 52.5, 57.5, 62.5, 67.5));
}

TEST_F(LatentVideoTest, BridgesNoLongGap) {
  events(0, 1200);
  frame(20);
  frame(1100);
  for (const double stamp : latentStamps_ms()) {
    EXPECT_TRUE(stamp < 30.0 || stamp > 1090.0) << stamp;
  }
  EXPECT_EQ(sink.latent_images.size(), 8u);
}

TEST_F(LatentVideoTest, StampsIncreaseWhereExposuresOverlap) {
  events(0, 100);
  frame(20);
  frame(33);  // 23 to 43 ms
  EXPECT_THAT(latentStamps_ms(), ElementsAre(12.5, 17.5, 22.5, 27.5, 30.5, 35.5, 40.5));
}

TEST_F(LatentVideoTest, BeginsAnewAfterAPauseAndATimeJump) {
  events(100, 200);
  frame(150);
  pipeline().pause();
  events(0, 100);
  frame(50);
  EXPECT_THAT(latentStamps_ms(), ElementsAre(142.5, 147.5, 152.5, 157.5, 42.5, 47.5, 52.5, 57.5));
}

}  // namespace
}  // namespace fast_edi
