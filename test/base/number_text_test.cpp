#include "fast_edi/base/number_text.hpp"

#include <clocale>
#include <limits>
#include <locale>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/comma_locale.hpp"

namespace fast_edi {
namespace {

TEST(NumberText, HasADecimalPointUnderEveryLocale) {
  const testing::CommaLocale comma;
  EXPECT_EQ(numberText(0.25), "0.25");
  EXPECT_EQ(numberText(13'000'000.0), "13000000");
  EXPECT_EQ(numberText(-3e15), "-3e+15");
  EXPECT_EQ(numberText(130.0 / 6.0), "21.6667");
  EXPECT_EQ(roundedText(1234.5678, 6), "1234.57");
  EXPECT_EQ(fixedText(1234567.125, 2), "1234567.12");
  EXPECT_EQ(exactText(0.1), "0.1");
  EXPECT_EQ(exactText(1e6), "1000000");
}

TEST(NumberText, ExactTextIsReadBackTheSame) {
  const testing::CommaLocale comma;
  for (const double value : {0.1, 1.0 / 3.0, 130.0 / 6.0, -3e15, 6.02214076e23, 1e-300, 5e-324,
                             std::numeric_limits<double>::max()}) {
    EXPECT_EQ(parseNumber(exactText(value)), value);
  }
}

TEST(ParseNumber, TakesWholeDecimalNumbersAlone) {
  const testing::CommaLocale comma;
  EXPECT_EQ(parseNumber("0.25"), 0.25);
  EXPECT_EQ(parseNumber("-1e4"), -1e4);
  EXPECT_EQ(parseNumber("+7"), 7.0);
  for (const char* text : {"", " 1", "1 ", "0,25", "1.000.000", "1e999", "0x10", "nan", "inf",
                           ".inf", "one", "1e", "--1"}) {
    EXPECT_EQ(parseNumber(text), std::nullopt) << text;
  }
}

}  // namespace
}  // namespace fast_edi
