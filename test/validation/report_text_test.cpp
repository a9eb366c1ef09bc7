// The report for people.
#include "validation/report_text.hpp"

#include <sstream>

#include <gmock/gmock.h>
#include <yaml-cpp/yaml.h>

#include "validation/synthetic_recording.hpp"

namespace fast_edi {
namespace {

using ::testing::HasSubstr;

std::string printed(const ValidationReport& report) {
  std::ostringstream out;
  printReport(out, testing::SyntheticRecording{}.run(), report);
  return out.str();
}

TEST(ReportTextTest, EndsWithLinesForAYamlFile) {
  ValidationReport report;
  report.notes = {"a note"};
  report.outcomes = "11 deblurred";
  report.proposal.stamp_reference = ExposureInstant::kStart;
  report.proposal.time_offset_us = -1500;
  const std::string text = printed(report);
  EXPECT_THAT(text, HasSubstr("frames: 12, every 40.0 ms; exposure messages: 12"));
  EXPECT_THAT(text, HasSubstr("sensor 16x16"));
  EXPECT_THAT(text, HasSubstr("with these parameters: 11 deblurred\n"));
  EXPECT_THAT(text, HasSubstr("note: a note"));
  const std::string intro = "no findings; proposal:\n\n";
  ASSERT_THAT(text, HasSubstr(intro));
  const YAML::Node yaml = YAML::Load(text.substr(text.find(intro) + intro.size()));
  EXPECT_EQ(yaml["stamp_reference"].as<std::string>(), "start");
  EXPECT_EQ(yaml["time_offset_us"].as<int>(), -1500);
  EXPECT_EQ(yaml["exposure_time_us"].as<int>(), 0);
}

YAML::Node proposalIn(const std::string& text) {
  const std::string intro = "proposal:\n\n";
  return YAML::Load(text.substr(text.find(intro) + intro.size()));
}

TEST(ReportTextTest, ProposesThresholdsWhereThereAreBetterOnes) {
  ValidationReport report;
  EXPECT_FALSE(proposalIn(printed(report))["contrast_threshold_on"]);
  report.proposal.thresholds = ContrastThresholds{0.358, 0.271};
  const YAML::Node yaml = proposalIn(printed(report));
  EXPECT_EQ(yaml["contrast_threshold_on"].as<double>(), 0.36);
  EXPECT_EQ(yaml["contrast_threshold_off"].as<double>(), 0.27);
}

TEST(ReportTextTest, TakesAGivenMappingBackThatIsWrong) {
  ValidationReport report;
  EXPECT_FALSE(proposalIn(printed(report))["event_polarity"]);
  EXPECT_FALSE(proposalIn(printed(report))["event_orientation"]);
  report.proposal.given_mapping = {EventPolarity::kInverted, EventOrientation::kFlipX};
  const YAML::Node yaml = proposalIn(printed(report));
  EXPECT_EQ(yaml["event_polarity"].as<std::string>(), "normal");
  EXPECT_EQ(yaml["event_orientation"].as<std::string>(), "normal");
}

TEST(ReportTextTest, FindingsSayWhatWasExpectedFoundAndIsToBeSet) {
  ValidationReport report;
  report.findings = {{"a-name", "this", "that", "something"}};
  EXPECT_THAT(printed(report),
              HasSubstr("[a-name]\n  expected: this\n  found:    that\n  set:      something\n"));
  EXPECT_THAT(printed(report), HasSubstr("1 finding; proposal:"));
}

}  // namespace
}  // namespace fast_edi
