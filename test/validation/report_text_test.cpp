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

TEST(ReportTextTest, FindingsSayWhatWasExpectedFoundAndIsToBeSet) {
  ValidationReport report;
  report.findings = {{"a-name", "this", "that", "something"}};
  EXPECT_THAT(printed(report),
              HasSubstr("[a-name]\n  expected: this\n  found:    that\n  set:      something\n"));
  EXPECT_THAT(printed(report), HasSubstr("1 finding; proposal:"));
}

}  // namespace
}  // namespace fast_edi
