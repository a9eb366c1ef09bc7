#include "fast_edi/latent/middle_image.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include <gtest/gtest.h>

#include "fast_edi/events/event_counts.hpp"
#include "fast_edi/integral/double_integral.hpp"
#include "fast_edi/pipeline/deblurrer.hpp"
#include "support/event_generators.hpp"
#include "support/pipeline_input.hpp"

namespace fast_edi {
namespace {

constexpr std::int64_t kMs = kNanosecondsPerMillisecond;
constexpr SensorSize kSize{40, 30};
constexpr std::int64_t kZero = 1000 * kNanosecondsPerSecond;
constexpr ContrastThresholds kThresholds{0.3, 0.25};
const ExposureInterval kExposure{kZero + 10 * kMs, kZero + 30 * kMs};

std::vector<Event> someEvents() {
  return testing::makeEvents(testing::EventScene::kUniform, {kSize, 4000, kZero, 40 * kMs, 1});
}

std::vector<std::uint8_t> pixelsOf(const ImageView& image) {
  return {image.data, image.data + image.size.pixelCount()};
}

/// The frame with that reference, as the pipeline publishes it, and its video.
testing::RecordingSink published(ExposureInstant reference, bool motion, int film_hz = 0) {
  DeblurParameters parameters;
  parameters.thresholds = kThresholds;
  parameters.exposure_source = ExposureSource::kParameter;
  parameters.exposure_time_ns = kExposure.length();
  parameters.reference = reference;
  parameters.filter.motion = motion;
  parameters.latent.rate_hz = film_hz;
  testing::RecordingSink sink;
  sink.wants_latent_images = true;
  Deblurrer deblurrer(parameters, sink);
  deblurrer.addEvents(testing::wireView(testing::toWire(someEvents())), kSize, 1, 0);
  deblurrer.addFrame(testing::makeFrame(kExposure.at(ExposureInstant::kMid), kSize,
                                        testing::makeGreyImage(kSize, 3)),
                     0);
  EXPECT_EQ(sink.outputs.size(), 1U);
  return sink;
}

TEST(MiddleImage, IsTheFrameThatWouldBePublishedWithThatReference) {
  PixelEventLists lists(kSize, {});
  lists.keepIntervals(true);
  lists.append(testing::wireView(testing::toWire(someEvents())));
  const std::vector<std::uint8_t> blurry = testing::makeGreyImage(kSize, 3);
  const ImageView view = {blurry.data(), kSize, static_cast<std::size_t>(kSize.width),
                          PixelFormat::kMono8};
  const auto expected = published(ExposureInstant::kMid, true).outputs.at(0).pixels;
  for (const ExposureInstant reference : {ExposureInstant::kStart, ExposureInstant::kEnd}) {
    std::vector<float> gain(kSize.pixelCount());
    const LevelModel level = DeblurParameters{}.level;
    DoubleIntegral integral(kSize, kThresholds, Weighting::kTime, level);
    integral.integrate(lists, kExposure, kExposure.at(reference), gain.data());
    LatentImage latent_image(FilterParameters{});
    MiddleImage middle(latent_image);
    middle.take(gain, lists, {kExposure.at(reference), kExposure.end_ns}, {kThresholds, level});
    EventCounts counts(kSize);
    counts.count(lists, kExposure);
    const std::vector<std::uint8_t> shown = pixelsOf(middle.show(
        view, {counts.data(), kThresholds}, lists,
        {kExposure.at(ExposureInstant::kMid), kExposure.end_ns}, CameraResponse::linear()));
    ASSERT_EQ(shown.size(), expected.size());
    int largest = 0;
    for (std::size_t i = 0; i < shown.size(); ++i) {
      largest = std::max(largest, std::abs(int{shown[i]} - int{expected[i]}));
    }
    EXPECT_LE(largest, 1);  // one rounding for each event of the way
    EXPECT_GE(middle.memoryBytes(), 13 * kSize.pixelCount());
  }
}

TEST(MiddleImage, SteadiesFramesOfOtherReferencesOnly) {
  for (const ExposureInstant reference : {ExposureInstant::kStart, ExposureInstant::kEnd}) {
    EXPECT_NE(published(reference, true).outputs.at(0).pixels,
              published(reference, false).outputs.at(0).pixels);
  }
  EXPECT_EQ(published(ExposureInstant::kMid, true).outputs.at(0).pixels,
            published(ExposureInstant::kMid, false).outputs.at(0).pixels);
}

TEST(MiddleImage, FrameAndVideoShowTheSameAtTheSameInstant) {
  // Of a film with 100 images a second, one falls on the start of the exposure.
  const testing::RecordingSink sink = published(ExposureInstant::kStart, true, 100);
  ASSERT_EQ(sink.latent_images.size(), 2U);
  ASSERT_EQ(sink.latent_images[0].stamp_ns, sink.outputs.at(0).frame.stamp_ns);
  EXPECT_EQ(sink.latent_images[0].pixels, sink.outputs.at(0).pixels);
  // The other one on its middle.
  EXPECT_EQ(sink.latent_images[1].stamp_ns, kExposure.at(ExposureInstant::kMid));
}

}  // namespace
}  // namespace fast_edi
