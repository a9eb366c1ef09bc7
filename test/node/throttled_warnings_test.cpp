// Lines of the log, as they come out of this process.
#include "node/throttled_warnings.hpp"

#include <cstdint>
#include <string>

#include <gmock/gmock.h>

namespace fast_edi {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr std::int64_t kNow_ns = 100 * kNanosecondsPerSecond;

class ThrottledWarningsTest : public ::testing::Test {
 protected:
  std::string warn(const std::string& kind, const std::string& text, std::int64_t now_ns) {
    ::testing::internal::CaptureStderr();
    warnings_.warn(kind, text, now_ns);
    return ::testing::internal::GetCapturedStderr();
  }

  ThrottledWarnings warnings_{"/deblur"};
};

TEST_F(ThrottledWarningsTest, TheFirstOfAKindIsWrittenWithTheNameOfTheNode) {
  EXPECT_THAT(warn("events", "some are lost", 0), HasSubstr("/deblur: some are lost"));
}

TEST_F(ThrottledWarningsTest, TheNextOfAKindWaitForTheInterval) {
  warn("events", "first", kNow_ns);
  EXPECT_THAT(warn("events", "second", kNow_ns + ThrottledWarnings::kInterval_ns - 1), IsEmpty());
  EXPECT_THAT(warn("events", "third", kNow_ns + ThrottledWarnings::kInterval_ns),
              HasSubstr("third"));
}

TEST_F(ThrottledWarningsTest, KindsDoNotWaitForEachOther) {
  warn("events", "first", kNow_ns);
  EXPECT_THAT(warn("frames", "other", kNow_ns), HasSubstr("other"));
}

TEST_F(ThrottledWarningsTest, WhatWasWrittenElsewhereCounts) {
  warnings_.note("values", kNow_ns);
  EXPECT_THAT(warn("values", "again", kNow_ns + 1), IsEmpty());
}

}  // namespace
}  // namespace fast_edi
