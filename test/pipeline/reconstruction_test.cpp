#include "pipeline/reconstruction.hpp"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "support/event_generators.hpp"
#include "support/pipeline_input.hpp"
#include "support/reference_double_integral.hpp"

namespace fast_edi {
namespace {

constexpr std::int64_t kMs = kNanosecondsPerMillisecond;
constexpr SensorSize kSize{16, 12};
constexpr ExposureInterval kWindow{10 * kMs, 30 * kMs};

class ReconstructionTest : public ::testing::Test {
 protected:
  ReconstructionTest() {
    parameters.thresholds = {0.3, 0.25};
    parameters.filter.enabled = false;
    list = testing::makeEvents(testing::EventScene::kUniform, {kSize, 800, 0, 40 * kMs, 1});
    events.take(testing::wireView(testing::toWire(list)), kSize, {});
  }

  /// One frame; returns the number of images of the video behind it.
  std::size_t render() {
    reconstruction.setFilter(parameters.filter);
    integral.adopt(parameters);
    EXPECT_TRUE(integral.prepare(events, parameters, true));
    const std::int64_t reference_ns = kWindow.at(parameters.reference);
    integral.integrate(*events.lists(), kWindow, reference_ns,
                       WindowIntegral::countingFor(parameters));
    OutputFrame output;
    output.input = testing::makeFrame(20 * kMs, kSize, testing::makeGreyImage(kSize, 3));
    output.exposure = kWindow;
    reconstruction.render({output, kWindow, reference_ns, 0}, integral, events, parameters);
    sink.finish(output);
    return reconstruction.writeVideo(events, parameters);
  }

  DeblurParameters parameters;
  DeblurCounters counters;
  EventStream events{{}, counters, [](StreamReset, std::int64_t) {}};
  WindowIntegral integral;
  testing::RecordingSink sink;
  Reconstruction reconstruction{sink, parameters.filter};
  std::vector<Event> list;
};

TEST_F(ReconstructionTest, PlainImagesAreTheBlurryOneOverTheIntegral) {
  EXPECT_EQ(render(), 0u);
  const auto expected = testing::referenceDoubleIntegral(kSize, list, parameters.thresholds,
                                                         parameters.weighting, kWindow, 20 * kMs);
  const std::vector<std::uint8_t> blurry = testing::makeGreyImage(kSize, 3);
  for (std::size_t i = 0; i < expected.size(); ++i) {
    ASSERT_NEAR(sink.outputs.at(0).pixels[i], std::min(255.0, blurry[i] / expected[i]), 0.51);
  }
}

TEST_F(ReconstructionTest, VideoIsWrittenWhereItIsSetAndWanted) {
  parameters.latent.per_exposure = 4;
  EXPECT_EQ(render(), 0u);
  sink.wants_latent_images = true;
  EXPECT_EQ(render(), 4u);
  EXPECT_EQ(sink.latent_images.size(), 4u);
}

TEST_F(ReconstructionTest, ShowsWhatReblurringTrusts) {
  parameters.filter.enabled = true;
  parameters.filter.reblur = false;
  render();
  EXPECT_TRUE(sink.trust_maps.empty());
  parameters.filter.reblur = true;
  render();
  ASSERT_EQ(sink.trust_maps.size(), 1u);
  EXPECT_EQ(sink.trust_maps.front().size(), kSize.pixelCount());
  EXPECT_TRUE(sink.isBalanced());
}

TEST_F(ReconstructionTest, StabilisesOnlyAwayFromMidExposure) {
  parameters.filter.enabled = true;
  for (const ExposureInstant reference : {ExposureInstant::kMid, ExposureInstant::kEnd}) {
    parameters.reference = reference;
    parameters.filter.motion = true;
    render();
    parameters.filter.motion = false;
    render();
  }
  ASSERT_EQ(sink.outputs.size(), 4u);
  EXPECT_EQ(sink.outputs[0].pixels, sink.outputs[1].pixels);
  EXPECT_TRUE(sink.isBalanced());
}

TEST_F(ReconstructionTest, FusionStartsAnewAfterAnInterruption) {
  parameters.filter.enabled = true;
  parameters.filter.temporal = 0.5;
  render();
  reconstruction.interrupt();
  render();
  EXPECT_EQ(sink.outputs.at(0).pixels, sink.outputs.at(1).pixels);
}

TEST_F(ReconstructionTest, CopiesTheInput) {
  OutputFrame output;
  output.input = testing::makeFrame(0, kSize, testing::makeGreyImage(kSize, 4));
  reconstruction.copy(output.input);
  sink.finish(output);
  EXPECT_EQ(sink.outputs.at(0).pixels, testing::makeGreyImage(kSize, 4));
  reconstruction.copy({});  // a frame without pixels
  sink.finish({});
  EXPECT_TRUE(sink.outputs.at(1).pixels.empty());
}

}  // namespace
}  // namespace fast_edi
