#include "tuning/first_frame.hpp"

#include <vector>

#include <gmock/gmock.h>

#include "fast_edi/events/event_wire.hpp"

namespace fast_edi {
namespace {

constexpr std::int64_t kStart_ns = 1'000 * kNanosecondsPerSecond;
constexpr std::int64_t kPeriod_ns = 40 * kNanosecondsPerMillisecond;
constexpr SensorSize kSize{48, 36};

/// \param rates events of each frame's period
RecordingSurvey surveyOf(const std::vector<int>& rates, std::int32_t exposure_us) {
  RecordingSurvey survey{AssumedParameters{}};
  std::uint32_t sequence = 0;
  for (const int events : rates) {
    const std::int64_t middle_ns = kStart_ns + sequence * kPeriod_ns;
    std::vector<std::uint8_t> records;
    for (int i = 0; i < events; ++i) {
      encodeWireEvent({1, 1, middle_ns - kPeriod_ns / 4 + i * kPeriod_ns / (2 * events), true},
                      records);
    }
    survey.addEvents({records.data(), static_cast<std::size_t>(events)}, kSize, sequence,
                     middle_ns + kPeriod_ns / 4);
    const std::vector<std::uint8_t> pixels(kSize.pixelCount());
    FrameMessage frame;
    frame.stamp_ns = middle_ns;
    frame.sequence = sequence;
    frame.record_ns = middle_ns + kPeriod_ns / 4;
    frame.size = kSize;
    frame.pixels = {pixels.data(), kSize, static_cast<std::size_t>(kSize.width)};
    survey.addFrame(frame);
    if (exposure_us > 0) {
      survey.addExposure(exposure_us, frame.record_ns);
    }
    ++sequence;
  }
  survey.finish();
  return survey;
}

TEST(BusiestFrame, HasMostEventsDuringItsExposure) {
  const std::vector<int> rates = {100, 300, 900, 200, 100};
  EXPECT_EQ(busiestFrame(surveyOf(rates, 20'000), 0), 2u);
  EXPECT_EQ(busiestFrame(surveyOf(rates, 0), 0), 2u);
}

TEST(BusiestFrame, TheOffsetCounts) {
  EXPECT_EQ(busiestFrame(surveyOf({100, 300, 900, 200, 100}, 20'000), kPeriod_ns), 1u);
}

TEST(BusiestFrame, OfNothingIsTheFirst) {
  EXPECT_EQ(busiestFrame(surveyOf({}, 0), 0), 0u);
}

}  // namespace
}  // namespace fast_edi
