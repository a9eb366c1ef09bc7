// Simulated recordings through the whole validator: exposures, stamps and clocks that are known.
#include "fast_edi/validation/recording_validator.hpp"

#include <memory>
#include <string>

#include <gmock/gmock.h>

#include "fast_edi/simulation/davis_simulator.hpp"
#include "fast_edi/simulation/recording_faults.hpp"
#include "support/event_generators.hpp"
#include "validation/synthetic_recording.hpp"

namespace fast_edi {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using testing::namesOf;

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

/// A simulation, told to a validator in messages that may lie.
class Recording {
 public:
  explicit Recording(double swing)
      : settings_(settings(swing)), sequence_(simulateSequence(settings_)) {}

  struct Told {
    ExposureInstant stamp = ExposureInstant::kMid;
    std::string fault;  ///< of the events' clock and polarity
    bool exposures = true;
    int exposure_of = 0;  ///< 1: of the next frame
    AssumedParameters parameters;
  };

  ValidationReport validate(const Told& told) const {
    RecordingFaults faults;
    if (!told.fault.empty()) {
      plantFault(told.fault, faults);
    }
    FaultyStream faulty(faults, settings_.sensor.size, settings_.timing);
    std::vector<Event> events = sequence_.events;
    faulty.apply({}, events);
    for (Event& event : events) {
      event.t_ns = faulty.eventStamp(event.t_ns);
    }
    const std::vector<std::uint8_t> wire = testing::toWire(events);
    AssumedParameters parameters = told.parameters;
    parameters.thresholds = settings_.sensor.thresholds;
    parameters.thresholds_given = true;
    RecordingValidator validator(parameters);
    tell(told, testing::wireView(wire), validator);
    if (validator.endSurvey()) {
      tell(told, testing::wireView(wire), validator);
    }
    return validator.finish(nullptr);
  }

 private:
  void tell(const Told& told, const WireEvents& events, RecordingValidator& validator) const {
    const std::int64_t end_ns = sequence_.frames.back().exposure.end_ns;
    validator.addEvents(events, settings_.sensor.size, 0, end_ns);
    for (std::size_t i = 0; i < sequence_.frames.size(); ++i) {
      const SimulatedFrame& simulated = sequence_.frames[i];
      FrameMessage frame;
      frame.stamp_ns = simulated.exposure.at(told.stamp);
      frame.sequence = static_cast<std::uint32_t>(i);
      frame.record_ns = simulated.exposure.end_ns;
      frame.size = settings_.sensor.size;
      frame.pixels.data = simulated.blurry.data;
      frame.pixels.size = frame.size;
      frame.pixels.step = simulated.blurry.step;
      validator.addFrame(frame);
      if (told.exposures) {
        validator.addExposure(static_cast<std::int32_t>(settings_.timing.exposureUs(
                                  static_cast<int>(i) + told.exposure_of)),
                              frame.record_ns + kNanosecondsPerMicrosecond);
      }
    }
  }

  SimulationSettings settings_;
  SimulatedSequence sequence_;
};

class RecordingValidatorTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    equal_ = std::make_unique<Recording>(0.0);
    varying_ = std::make_unique<Recording>(0.4);
  }
  static void TearDownTestSuite() {
    equal_.reset();
    varying_.reset();
  }
  static std::unique_ptr<Recording> equal_;
  static std::unique_ptr<Recording> varying_;
};

std::unique_ptr<Recording> RecordingValidatorTest::equal_;
std::unique_ptr<Recording> RecordingValidatorTest::varying_;

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
  Recording::Told told;
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
    Recording::Told told;
    told.fault = "clock-offset=" + std::to_string(static_cast<int>(offset_ms * 1e3));
    const ValidationReport report = equal_->validate(told);
    EXPECT_NEAR(report.timing.shift_ns - clean_ns, offset_ms * kMs, 0.3 * kMs);
    EXPECT_NEAR(static_cast<double>(report.proposal.time_offset_us), offset_ms * 1e3, 1000.0);
  }
}

TEST_F(RecordingValidatorTest, VaryingExposuresSeparateStampsAndOffset) {
  Recording::Told told;
  told.stamp = ExposureInstant::kStart;
  told.fault = "clock-offset=6000";
  const ValidationReport report = varying_->validate(told);
  ASSERT_TRUE(report.timing.reference);
  EXPECT_EQ(*report.timing.reference, ExposureInstant::kStart);
  EXPECT_NEAR(report.timing.offset_ns, 6.0 * kMs, 1.0 * kMs);
  EXPECT_EQ(report.proposal.stamp_reference, ExposureInstant::kStart);
}

TEST_F(RecordingValidatorTest, ExposuresOfTheNextFrameAreNoticed) {
  Recording::Told told;
  told.exposure_of = 1;
  EXPECT_THAT(namesOf(varying_->validate(told).findings), ElementsAre("exposure-of-next-frame"));
}

TEST_F(RecordingValidatorTest, AnUnknownExposureIsEstimated) {
  Recording::Told told;
  told.exposures = false;
  const ValidationReport report = equal_->validate(told);
  EXPECT_THAT(namesOf(report.findings), ElementsAre("exposure-missing"));
  EXPECT_NEAR(static_cast<double>(report.proposal.exposure_time_us), 20'000.0, 4'000.0);
}

TEST_F(RecordingValidatorTest, InvertedPolaritiesAreNamed) {
  Recording::Told told;
  told.fault = "invert-polarity";
  EXPECT_THAT(namesOf(equal_->validate(told).findings), ElementsAre("polarity-inverted"));
}

TEST_F(RecordingValidatorTest, OnePolarityTellsNothingOfStamps) {
  Recording::Told told;
  told.fault = "suppress-on";
  const ValidationReport report = equal_->validate(told);
  EXPECT_THAT(namesOf(report.findings), ElementsAre("polarity-missing"));
  EXPECT_FALSE(report.timing.told);
}

}  // namespace
}  // namespace fast_edi
