// Simulated recordings through the whole validator: exposures, stamps and clocks that are known.
#include "validation/recording_validator.hpp"

#include <algorithm>
#include <memory>
#include <string>

#include <gmock/gmock.h>

#include "validation/simulated_recording.hpp"
#include "validation/synthetic_recording.hpp"

namespace fast_edi {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::Field;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::namesOf;
using ::testing::Not;
using testing::SimulatedRecording;

constexpr double kMs = static_cast<double>(kNanosecondsPerMillisecond);

SimulationSettings settings(double swing) {
  SimulationSettings settings;
  settings.sensor.size = {120, 90};
  settings.motion.kind = MotionKind::kPan;
  settings.scene.texture = TextureKind::kNatural;
  settings.timing.frames = swing > 0.0 ? 18 : 10;
  settings.timing.exposure_swing = swing;
  settings.seed = 3;
  return settings;
}

class RecordingValidatorTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    equal_ = std::make_unique<SimulatedRecording>(settings(0.0));
    varying_ = std::make_unique<SimulatedRecording>(settings(0.4));
  }
  static void TearDownTestSuite() {
    equal_.reset();
    varying_.reset();
  }
  static std::unique_ptr<SimulatedRecording> equal_;
  static std::unique_ptr<SimulatedRecording> varying_;
};

std::unique_ptr<SimulatedRecording> RecordingValidatorTest::equal_;
std::unique_ptr<SimulatedRecording> RecordingValidatorTest::varying_;

TEST_F(RecordingValidatorTest, ACleanRecordingHasNoFindings) {
  const ValidationReport report = equal_->validate({});
  EXPECT_THAT(namesOf(report.findings), IsEmpty());
  EXPECT_TRUE(report.timing.told);
  EXPECT_NEAR(report.timing.shift_ns, 0.0, 0.8 * kMs);
  EXPECT_NEAR(report.timing.length_factor, 1.0, 0.2);
  EXPECT_FALSE(report.timing.reference);
  EXPECT_FALSE(report.timing.curve.empty());
}

TEST_F(RecordingValidatorTest, StampsAtStartAndEndAreNamed) {
  SimulatedRecording::Told told;
  told.stamp = ExposureInstant::kStart;
  EXPECT_EQ(equal_->validate(told).proposal.stamp_reference, ExposureInstant::kStart);
  told.parameters.stamp_reference = ExposureInstant::kStart;
  EXPECT_THAT(namesOf(equal_->validate(told).findings), IsEmpty());
  told.stamp = ExposureInstant::kEnd;
  const ValidationReport end = equal_->validate(told);
  EXPECT_THAT(namesOf(end.findings), Contains("timing"));
  EXPECT_EQ(end.proposal.stamp_reference, ExposureInstant::kEnd);
}

TEST_F(RecordingValidatorTest, AnOffsetIsFoundWithinAMillisecond) {
  const double clean_ns = equal_->validate({}).timing.shift_ns;
  for (const double offset_ms : {-7.0, 4.0}) {
    SimulatedRecording::Told told;
    told.fault = "clock-offset=" + std::to_string(static_cast<int>(offset_ms * 1e3));
    const ValidationReport report = equal_->validate(told);
    EXPECT_NEAR(report.timing.shift_ns - clean_ns, offset_ms * kMs, 0.3 * kMs);
    EXPECT_NEAR(static_cast<double>(report.proposal.time_offset_us), offset_ms * 1e3, 1000.0);
  }
}

TEST_F(RecordingValidatorTest, VaryingExposuresSeparateStampsAndOffset) {
  SimulatedRecording::Told told;
  told.stamp = ExposureInstant::kStart;
  told.fault = "clock-offset=6000";
  const ValidationReport report = varying_->validate(told);
  ASSERT_TRUE(report.timing.reference);
  EXPECT_EQ(*report.timing.reference, ExposureInstant::kStart);
  EXPECT_NEAR(report.timing.offset_ns, 6.0 * kMs, 1.0 * kMs);
  EXPECT_EQ(report.proposal.stamp_reference, ExposureInstant::kStart);
}

TEST_F(RecordingValidatorTest, ExposuresOfTheNextFrameAreNoticed) {
  SimulatedRecording::Told told;
  told.exposure_of = 1;
  EXPECT_THAT(namesOf(varying_->validate(told).findings), ElementsAre("exposure-of-next-frame"));
}

TEST_F(RecordingValidatorTest, AnUnknownExposureIsEstimated) {
  SimulatedRecording::Told told;
  told.exposures = false;
  const ValidationReport report = equal_->validate(told);
  EXPECT_THAT(namesOf(report.findings), ElementsAre("exposure-missing"));
  EXPECT_NEAR(static_cast<double>(report.proposal.exposure_time_us), 20'000.0, 4'000.0);
}

TEST_F(RecordingValidatorTest, InvertedPolaritiesAreNamedAndTheRestIsToldAllTheSame) {
  SimulatedRecording::Told told;
  told.fault = "invert-polarity";
  told.exposures = false;
  const ValidationReport report = equal_->validate(told);
  EXPECT_THAT(namesOf(report.findings), ElementsAre("exposure-missing", "polarity-inverted"));
  EXPECT_EQ(report.findings[1].set, "event_polarity: inverted");
  EXPECT_EQ(report.proposal.event_mapping.polarity, EventPolarity::kInverted);
  EXPECT_NEAR(static_cast<double>(report.proposal.exposure_time_us), 20'000.0, 4'000.0);
}

TEST_F(RecordingValidatorTest, EachOrientationIsNamed) {
  for (std::size_t i = 1; i < kEventOrientations.size(); ++i) {
    SimulatedRecording::Told told;
    told.fault = "event-orientation=" + std::to_string(i);
    const ValidationReport report = equal_->validate(told);
    const std::string word = kEventOrientations[i].first;
    ASSERT_THAT(namesOf(report.findings), Contains("orientation")) << word;
    EXPECT_EQ(report.proposal.event_mapping.orientation, kEventOrientations[i].second) << word;
    EXPECT_THAT(report.findings, Contains(Field(&Finding::set, "event_orientation: " + word)));
    EXPECT_TRUE(report.timing.told);
    EXPECT_NEAR(report.timing.shift_ns, 0.0, 0.8 * kMs) << word;
  }
}

TEST_F(RecordingValidatorTest, CoordinatesFromOneAreNamed) {
  SimulatedRecording::Told told;
  told.fault = "coordinates-from";
  EXPECT_THAT(namesOf(equal_->validate(told).findings), Contains("coordinates-from-1"));
  told.fault = "event-hole";
  EXPECT_THAT(namesOf(equal_->validate(told).findings), Not(Contains("coordinates-from-1")));
}

TEST_F(RecordingValidatorTest, DoubledFrameStampsAreNamedAndTheRestIsForTheirHalves) {
  SimulatedRecording::Told told;
  told.fault = "frame-stamps-times";
  const ValidationReport report = equal_->validate(told);
  const auto found = std::find_if(report.findings.begin(), report.findings.end(),
                                  [](const Finding& f) { return f.name == "clocks-differ"; });
  ASSERT_NE(found, report.findings.end());
  EXPECT_THAT(found->found, HasSubstr("frame stamps are exactly doubled"));
  EXPECT_EQ(report.proposal.offset_remark, "for frame stamps divided by 2");
  EXPECT_EQ(report.proposal.time_offset_us, 0);
  EXPECT_TRUE(report.timing.told);
  EXPECT_EQ(report.counters.frames_deblurred, 0u);
}

TEST_F(RecordingValidatorTest, ClocksSecondsApartAreToldByHowMuch) {
  for (const std::int64_t offset_ms : {5'000, -40'000}) {
    SimulatedRecording::Told told;
    told.fault = "clock-offset=" + std::to_string(1000 * offset_ms);
    const ValidationReport report = equal_->validate(told);
    EXPECT_THAT(namesOf(report.findings), Contains("clocks-differ"));
    EXPECT_NEAR(static_cast<double>(report.proposal.time_offset_us), 1e3 * offset_ms, 1000.0);
    EXPECT_EQ(report.counters.frames_deblurred, 0u);
    EXPECT_GE(report.counters.frames_passed[static_cast<std::size_t>(PassReason::kClocksDiffer)],
              7u);
  }
}

TEST_F(RecordingValidatorTest, OnePolarityTellsNothingOfStamps) {
  SimulatedRecording::Told told;
  told.fault = "suppress-on";
  const ValidationReport report = equal_->validate(told);
  EXPECT_THAT(namesOf(report.findings), ElementsAre("polarity-missing"));
  EXPECT_FALSE(report.timing.told);
}

}  // namespace
}  // namespace fast_edi
