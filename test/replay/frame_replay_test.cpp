#include "replay/frame_replay.hpp"

#include <algorithm>
#include <cstdlib>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include "fast_edi/bags/bag_pipeline.hpp"
#include "fast_edi/bags/open_messages.hpp"
#include "fast_edi/config/parameters_from_yaml.hpp"

namespace fast_edi {
namespace {

const std::string kDemoBag = FAST_EDI_SOURCE_DIR "/bags/demo.bag";
const std::string kConfig = FAST_EDI_SOURCE_DIR "/cfg/davis346.yaml";
constexpr std::int64_t kMargin_ns = 400 * kNanosecondsPerMillisecond;

/// Parameters with which nothing is learned.
LoadedParameters parametersOf(std::vector<std::string> overrides) {
  overrides.emplace_back("refine_contrast:=false");
  overrides.emplace_back("refine_delay:=false");
  return parametersFromFile(kConfig, overrides);
}

struct Demo {
  std::vector<BagPipeline::Output> outputs;  ///< of the recording as a whole
  std::vector<std::int32_t> exposures_us;
};

Demo deblurAll(const LoadedParameters& parameters) {
  const auto source = openMessages(kDemoBag);
  BagPipeline pipeline(TopicNames{}, parameters);
  BagMessage message;
  while (source->next(message)) {
    pipeline.add(message);
  }
  pipeline.finish();
  Demo demo;
  demo.outputs = pipeline.takeOutputs();
  for (const BagPipeline::Output& output : demo.outputs) {
    demo.exposures_us.push_back(
        static_cast<std::int32_t>(output.frame.exposure.length() / kNanosecondsPerMicrosecond));
  }
  return demo;
}

FrameWindow windowOf(const std::vector<std::int32_t>& exposures_us, std::size_t frames_before) {
  return {[] { return openMessages(kDemoBag); },
          TopicNames{},
          exposures_us,
          {frames_before, kMargin_ns}};
}

/// Pixels that differ by more than \p levels.
std::size_t differences(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b,
                        int levels) {
  EXPECT_EQ(a.size(), b.size());
  std::size_t count = 0;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    count += std::abs(a[i] - b[i]) > levels ? 1 : 0;
  }
  return count;
}

/// \param most pixels of a frame may differ by more than \p levels
void expectSame(const std::vector<std::string>& overrides, int levels = 0, std::size_t most = 0) {
  const LoadedParameters parameters = parametersOf(overrides);
  const Demo demo = deblurAll(parameters);
  FrameWindow window = windowOf(demo.exposures_us, framesBefore(parameters.deblur));
  for (const std::size_t frame : {0, 1, 14, 29}) {
    ASSERT_TRUE(window.moveTo(frame));
    const ReplayedFrame replayed = replayFrame(window, parameters);
    const BagPipeline::Output& expected = demo.outputs[frame];
    ASSERT_NE(replayed.output, nullptr);
    EXPECT_EQ(replayed.input->header.stamp,
              messageFrame(expected.frame.input).message->header.stamp);
    EXPECT_EQ(replayed.output->header.stamp, expected.image->header.stamp);
    EXPECT_EQ(replayed.result.deblurred, expected.frame.deblurred);
    EXPECT_EQ(replayed.result.events, expected.frame.events);
    EXPECT_LE(differences(replayed.output->data, expected.image->data, levels), most)
        << "frame " << frame;
  }
}

TEST(FrameReplay, HasTheBitsOfTheWholeRecording) {
  expectSame({});
}

TEST(FrameReplay, OtherParametersToo) {
  expectSame({"contrast_threshold_on:=0.4", "time_offset_us:=-2000", "stamp_reference:=start",
              "filter:=false"});
}

TEST(FrameReplay, BlendedFramesAreHardlyMoreThanAGreyLevelApart) {
  constexpr std::size_t kFew = 346 * 260 / 1000;
  expectSame({"filter_temporal:=0.3"}, 1, kFew);
}

TEST(FrameReplay, ShowsTheEventsOfTheExposure) {
  const LoadedParameters parameters = parametersOf({});
  FrameWindow window = windowOf(std::vector<std::int32_t>(30, 18'000), 1);
  ASSERT_TRUE(window.moveTo(14));
  const ReplayedFrame replayed = replayFrame(window, parameters);
  ASSERT_EQ(replayed.events.type(), CV_8UC3);
  EXPECT_EQ(replayed.events.cols, static_cast<int>(replayed.input->width));
  EXPECT_EQ(replayed.events.rows, static_cast<int>(replayed.input->height));
  EXPECT_LT(cv::mean(replayed.events)[1], 250.0);
}

TEST(FrameReplay, AFrameOfNoKnownExposureIsPassedThrough) {
  const LoadedParameters parameters = parametersOf({});
  FrameWindow window = windowOf({}, 1);
  ASSERT_TRUE(window.moveTo(14));
  const ReplayedFrame replayed = replayFrame(window, parameters);
  ASSERT_NE(replayed.output, nullptr);
  EXPECT_FALSE(replayed.result.deblurred);
  EXPECT_EQ(replayed.result.pass_reason, PassReason::kExposureUnknown);
  EXPECT_TRUE(replayed.output->data == replayed.input->data);
  EXPECT_TRUE(replayed.events.empty());
  // The parameter is what it falls back on.
  const ReplayedFrame known = replayFrame(window, parametersOf({"exposure_time_us:=18000"}));
  EXPECT_TRUE(known.result.deblurred);
}

TEST(FrameReplay, FramesBeforeGrowWithTheBlending) {
  DeblurParameters parameters;
  EXPECT_EQ(framesBefore(parameters), 1u);
  parameters.filter.temporal = 0.5;
  EXPECT_EQ(framesBefore(parameters), 9u);  // 0.5^9 < 1/510
  parameters.filter.temporal = 0.9;
  EXPECT_EQ(framesBefore(parameters), mostFramesBefore());
  EXPECT_EQ(mostFramesBefore(), 60u);
  parameters.filter.enabled = false;
  EXPECT_EQ(framesBefore(parameters), 1u);
}

}  // namespace
}  // namespace fast_edi
