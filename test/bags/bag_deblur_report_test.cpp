#include <sstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fast_edi/bags/bag_deblurrer.hpp"

namespace fast_edi {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

std::string summaryOf(const BagDeblurReport& report) {
  std::ostringstream text;
  printSummary(text, report);
  return text.str();
}

TEST(BagDeblurReport, NamesWhatWasLearned) {
  BagDeblurReport report;
  report.given_thresholds = {0.25, 0.3};
  report.thresholds = {0.25, 0.3};
  report.event_delay_ns = 1'500'000;
  EXPECT_THAT(summaryOf(report), Not(HasSubstr("in force at the end")));
  report.counters.calibration_fits = 12;
  EXPECT_THAT(
      summaryOf(report),
      AllOf(HasSubstr("in force at the end (learned from 12 pairs of frames)"),
            HasSubstr("0.250  contrast_threshold_on"), HasSubstr("0.300  contrast_threshold_off"),
            HasSubstr("1.50  ms by which events lag behind the light")));
}

TEST(BagDeblurReport, SaysWhenThresholdsLookWrong) {
  BagDeblurReport report;
  report.counters.calibration_fits = 12;
  report.given_thresholds = {0.25, 0.3};
  report.thresholds = {0.26, 0.29};
  EXPECT_THAT(summaryOf(report), Not(HasSubstr("look wrong")));
  report.thresholds = {0.325, 0.29};
  EXPECT_THAT(summaryOf(report),
              AllOf(HasSubstr("look wrong: 0.250, 0.300 (ON, OFF) given, 0.325, 0.290 learned"),
                    HasSubstr("validate_bag"), HasSubstr("tune")));
}

}  // namespace
}  // namespace fast_edi
