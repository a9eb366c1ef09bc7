#include "fast_edi/latent/temporal_fusion.hpp"

#include <cmath>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "fast_edi/pipeline/deblurrer.hpp"
#include "support/event_generators.hpp"
#include "support/pipeline_input.hpp"

namespace fast_edi {
namespace {

constexpr std::int64_t kMs = kNanosecondsPerMillisecond;
constexpr SensorSize kSize{8, 6};
constexpr std::int64_t kZero = 1000 * kNanosecondsPerSecond;
constexpr ContrastThresholds kThresholds{0.3, 0.2};
constexpr double kWeight = 0.25;
constexpr std::int64_t kExposure_ns = 10 * kMs;

/// Images and events by hand. Times in milliseconds after kZero.
class TemporalFusionTest : public ::testing::Test {
 protected:
  TemporalFusionTest()
      : stream_(PixelEventLists::Limits{}, counters_, [](StreamReset, std::int64_t) {}) {
    event(0, 0, 0, true);
  }

  void event(double t_ms, std::uint16_t x, std::uint16_t y, bool on) {
    const std::vector<Event> one = {{x, y, kZero + std::llround(t_ms * kMs), on}};
    stream_.take(testing::wireView(testing::toWire(one)), kSize, ++sequence_);
  }

  /// \return the image after it was drawn towards the one before
  std::vector<std::uint8_t> show(double t_ms, int level, std::int64_t exposure_ns = kExposure_ns,
                                 std::uint64_t epoch = 0) {
    std::vector<std::uint8_t> pixels(kSize.pixelCount(), static_cast<std::uint8_t>(level));
    drawn_ = fusion_.apply(
        {{kZero + std::llround(t_ms * kMs), INT64_MAX}, exposure_ns, epoch}, stream_,
        {kThresholds, {}}, CameraResponse::linear(), kWeight,
        {pixels.data(), kSize, static_cast<std::size_t>(kSize.width), PixelFormat::kMono8});
    return pixels;
  }
  static int at(const std::vector<std::uint8_t>& pixels, int x, int y) {
    return pixels[static_cast<std::size_t>(y * kSize.width + x)];
  }

  DeblurCounters counters_;
  EventStream stream_;
  TemporalFusion fusion_;
  std::uint32_t sequence_ = 0;
  bool drawn_ = false;
};

TEST_F(TemporalFusionTest, DrawsAnImageTowardsTheOneBeforeAndItsEvents) {
  event(5, 3, 2, true);  // before the first image
  EXPECT_EQ(at(show(10, 100), 3, 2), 100);
  EXPECT_FALSE(drawn_);
  event(12, 3, 2, true);
  event(13, 3, 2, true);
  event(14, 4, 2, false);
  event(40, 0, 0, true);
  const std::vector<std::uint8_t> image = show(30, 140);
  EXPECT_TRUE(drawn_);
  EXPECT_NEAR(at(image, 1, 1), 140 + kWeight * (100 - 140), 0.51);
  EXPECT_NEAR(at(image, 3, 2), 140 + kWeight * (100 * std::exp(0.6) - 140), 0.76);
  EXPECT_NEAR(at(image, 4, 2), 140 + kWeight * (100 * std::exp(-0.2) - 140), 0.76);
  EXPECT_GT(fusion_.memoryBytes(), 20 * kSize.pixelCount());
}

TEST_F(TemporalFusionTest, CarriesOnWhatWasShown) {
  event(50, 0, 0, true);
  show(10, 100);
  EXPECT_NEAR(at(show(20, 200), 1, 1), 175, 1);
  EXPECT_NEAR(at(show(30, 200), 1, 1), 200 - kWeight * 25, 1);
}

TEST_F(TemporalFusionTest, KnowsThatALongerExposureIsBrighter) {
  event(50, 0, 0, true);
  show(10, 60);
  EXPECT_EQ(at(show(30, 120, 2 * kExposure_ns), 1, 1), 120);
}

TEST_F(TemporalFusionTest, LeavesSaturatedPixels) {
  event(50, 0, 0, true);
  show(10, 255);
  EXPECT_EQ(at(show(20, 100), 1, 1), 100);
  EXPECT_EQ(at(show(30, 255), 1, 1), 255);
}

TEST_F(TemporalFusionTest, GoesNoFurtherThanEventsDo) {
  show(10, 100);
  event(15, 0, 0, true);
  EXPECT_EQ(at(show(20, 200), 1, 1), 200) << "events up to there have not come";
  sequence_ += 3;  // lost arrays
  event(25, 0, 0, true);
  event(60, 0, 0, true);
  EXPECT_EQ(at(show(30, 100), 1, 1), 100);
  show(40, 200);
  EXPECT_TRUE(drawn_) << "after them it goes on";
}

TEST_F(TemporalFusionTest, BeginsAnew) {
  event(100, 0, 0, true);
  show(10, 100);
  fusion_.reset();
  EXPECT_EQ(at(show(20, 200), 1, 1), 200);
  EXPECT_EQ(at(show(30, 100, kExposure_ns, 1), 1, 1), 100) << "another epoch of the frames' clock";
  EXPECT_EQ(at(show(30, 200, kExposure_ns, 1), 1, 1), 200) << "the same instant again";
}

TEST_F(TemporalFusionTest, DoesTheSameInEachFormat) {
  event(50, 0, 0, true);
  for (const PixelFormat format :
       {PixelFormat::kBayer8, PixelFormat::kMono16, PixelFormat::kColour8}) {
    const int dn = format == PixelFormat::kMono16 ? kDn16PerDn8 : 1;
    TemporalFusion fusion;
    StoredImage image;
    for (const int level : {100, 180}) {
      const MutableImageView view = image.reshape(kSize, format);
      for (int y = 0; y < kSize.height; ++y) {
        for (std::size_t i = 0; i < view.step; i += format == PixelFormat::kMono16 ? 2 : 1) {
          const auto wide = static_cast<std::uint16_t>(level * dn);
          view.row(y)[i] = static_cast<std::uint8_t>(wide & 0xffu);
          if (format == PixelFormat::kMono16)
            view.row(y)[i + 1] = static_cast<std::uint8_t>(wide >> 8u);
        }
      }
      fusion.apply({{kZero + (level == 100 ? 10 : 20) * kMs, INT64_MAX}, kExposure_ns, 0}, stream_,
                   {kThresholds, {}}, CameraResponse::linear(), kWeight, view);
    }
    const std::uint8_t* last = image.view().row(kSize.height - 1) + image.view().step - 2;
    const int level = format == PixelFormat::kMono16 ? last[0] + 256 * last[1] : last[1];
    EXPECT_NEAR(level, 160 * dn, dn);
  }
}

/// Two frames of the pipeline, 40 ms apart.
std::vector<std::vector<std::uint8_t>> pipelineFrames(double temporal, bool pause_between) {
  constexpr SensorSize kLarge{40, 30};
  DeblurParameters parameters;
  parameters.thresholds = kThresholds;
  parameters.exposure_source = ExposureSource::kParameter;
  parameters.exposure_time_ns = 20 * kMs;
  parameters.filter.temporal = temporal;
  testing::RecordingSink sink;
  Deblurrer deblurrer(parameters, sink);
  for (const std::int64_t from_ms : {0, 40}) {
    const auto events = testing::makeEvents(testing::EventScene::kUniform,
                                            {kLarge, 4000, kZero + from_ms * kMs, 40 * kMs, 1});
    deblurrer.addEvents(testing::wireView(testing::toWire(events)), kLarge,
                        static_cast<std::uint32_t>(from_ms / 40 + 1), 0);
    deblurrer.addFrame(
        testing::makeFrame(kZero + (from_ms + 20) * kMs, kLarge, testing::makeGreyImage(kLarge, 3)),
        0);
    if (pause_between) {
      deblurrer.pause();
    }
  }
  deblurrer.finish();
  std::vector<std::vector<std::uint8_t>> pixels;
  for (const auto& output : sink.outputs) {
    pixels.push_back(output.pixels);
  }
  return pixels;
}

TEST(TemporalFusionInThePipeline, IsOffByDefaultAndChangesAllButTheFirstFrame) {
  EXPECT_EQ(DeblurParameters{}.filter.temporal, 0.0);
  const auto without = pipelineFrames(0.0, false);
  const auto with = pipelineFrames(kWeight, false);
  ASSERT_EQ(without.size(), 2U);
  ASSERT_EQ(with.size(), 2U);
  EXPECT_EQ(with[0], without[0]);
  EXPECT_NE(with[1], without[1]);
}

TEST(TemporalFusionInThePipeline, BeginsAnewAfterAPause) {
  EXPECT_EQ(pipelineFrames(kWeight, true), pipelineFrames(0.0, true));
}

}  // namespace
}  // namespace fast_edi
