#include "pipeline/frame_renderer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "fast_edi/pipeline/deblurrer.hpp"
#include "support/event_generators.hpp"
#include "support/pipeline_input.hpp"

namespace fast_edi {
namespace {

constexpr std::int64_t kMs = kNanosecondsPerMillisecond;
constexpr SensorSize kSize{64, 48};

struct Image {
  std::vector<std::uint8_t> pixels;
  std::vector<float> trust;
};

/// Leaves the work on frames until it is asked for.
class DeferringSink : public FrameSink {
 public:
  MutableImageView begin(const InputFrame& input) override {
    images.push_back({std::vector<std::uint8_t>(input.image.size.pixelCount()), {}});
    return {images.back().pixels.data(), input.image.size,
            static_cast<std::size_t>(input.image.size.width), input.image.format};
  }
  void finish(const OutputFrame& output) override { deblurred += output.deblurred ? 1 : 0; }
  void noteTrust(const std::vector<float>& trust) override { images.back().trust = trust; }
  bool takesWork() const override { return takes_work; }
  void defer(const FrameWork& work) override { works.emplace_back(images.size() - 1, work); }

  bool takes_work = true;
  std::vector<Image> images;
  std::vector<std::pair<std::size_t, FrameWork>> works;
  int deblurred = 0;
};

class FrameRendererTest : public ::testing::Test {
 protected:
  FrameRendererTest() {
    parameters.thresholds = {0.3, 0.25};
    parameters.exposure_source = ExposureSource::kParameter;
    parameters.exposure_time_ns = 20 * kMs;
    events = testing::makeEvents(testing::EventScene::kUniform,
                                 {kSize, 400'000, 1'000 * kMs, 1'000 * kMs, 1});
  }

  void deblur(DeferringSink& sink) {
    Deblurrer deblurrer(parameters, sink);
    const std::size_t per_array = events.size() / 100;
    for (std::size_t i = 0; i < events.size(); i += per_array) {
      deblurrer.addEvents(&events[i], std::min(per_array, events.size() - i), kSize, 0);
      if (i / per_array % 4 == 0) {
        deblurrer.addFrame(
            testing::makeFrame(events[i].t_ns, kSize,
                               testing::makeGreyImage(kSize, static_cast<std::uint32_t>(i))),
            0);
      }
    }
    deblurrer.finish();
  }

  DeblurParameters parameters;
  std::vector<Event> events;
};

TEST_F(FrameRendererTest, WorkThatIsDoneLaterInAnyOrderGivesTheSameBits) {
  DeferringSink at_once;
  at_once.takes_work = false;
  deblur(at_once);
  ASSERT_GT(at_once.deblurred, 20);
  EXPECT_TRUE(at_once.works.empty());

  DeferringSink later;
  deblur(later);
  ASSERT_EQ(later.deblurred, at_once.deblurred);
  ASSERT_EQ(later.works.size(), static_cast<std::size_t>(later.deblurred));
  FrameRenderer one(parameters.filter);
  FrameRenderer other(parameters.filter);
  std::reverse(later.works.begin(), later.works.end());
  for (std::size_t i = 0; i < later.works.size(); ++i) {
    FrameRenderer& renderer = i % 3 == 0 ? other : one;
    auto& [image, work] = later.works[i];
    ASSERT_TRUE(work(renderer));
    later.images[image].trust = renderer.trust();
  }
  ASSERT_EQ(later.images.size(), at_once.images.size());
  for (std::size_t i = 0; i < later.images.size(); ++i) {
    EXPECT_EQ(later.images[i].pixels, at_once.images[i].pixels) << i;
    EXPECT_EQ(later.images[i].trust, at_once.images[i].trust) << i;
  }
}

TEST_F(FrameRendererTest, FramesThatOthersDependOnAreNotDeferred) {
  for (const int which : {0, 1}) {
    parameters.filter.temporal = which == 0 ? 0.5 : 0.0;
    parameters.reference = which == 1 ? ExposureInstant::kStart : ExposureInstant::kMid;
    DeferringSink sink;
    deblur(sink);
    EXPECT_GT(sink.deblurred, 20);
    EXPECT_TRUE(sink.works.empty());
  }
}

TEST_F(FrameRendererTest, WithoutReblurringThereIsNoTrust) {
  parameters.filter.reblur = false;
  DeferringSink sink;
  deblur(sink);
  ASSERT_FALSE(sink.works.empty());
  FrameRenderer renderer(parameters.filter);
  EXPECT_FALSE(sink.works.front().second(renderer));
  EXPECT_GT(renderer.memoryBytes(), 0u);
}

}  // namespace
}  // namespace fast_edi
