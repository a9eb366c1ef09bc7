// Words of reports.
#include "survey/finding.hpp"

#include <gtest/gtest.h>

namespace fast_edi {
namespace {

TEST(FindingTest, InstantsHaveTheNamesOfTheParameter) {
  EXPECT_EQ(instantName(ExposureInstant::kStart), "start");
  EXPECT_EQ(instantName(ExposureInstant::kMid), "mid");
  EXPECT_EQ(instantName(ExposureInstant::kEnd), "end");
}

TEST(FindingTest, TextIsAsLongAsItGets) {
  const std::string word(300, 'x');
  EXPECT_EQ(textOf("%s %d", word.c_str(), 7), word + " 7");
  EXPECT_EQ(textOf("plain"), "plain");
}

}  // namespace
}  // namespace fast_edi
