#include "fast_edi/base/classic_locale.hpp"

#include <array>
#include <cstdio>
#include <cstdlib>
#include <string>

#include <gtest/gtest.h>

#include "support/comma_locale.hpp"

namespace fast_edi {
namespace {

std::string printed(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.2f", value);
  return text.data();
}

TEST(ClassicLocale, HoldsForPrintfAndStrtodWhileItLives) {
  const testing::CommaLocale comma;
  const std::string before = printed(0.25);
  EXPECT_EQ(before, comma.cIsSet() ? "0,25" : "0.25");
  {
    const ClassicLocale classic;
    EXPECT_EQ(printed(0.25), "0.25");
    EXPECT_EQ(std::strtod("0.25", nullptr), 0.25);
  }
  EXPECT_EQ(printed(0.25), before);
}

}  // namespace
}  // namespace fast_edi
