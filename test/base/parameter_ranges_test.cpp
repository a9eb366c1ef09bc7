#include "fast_edi/base/parameter_ranges.hpp"

#include <cmath>
#include <stdexcept>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fast_edi/base/types.hpp"

namespace fast_edi {
namespace {

constexpr ParameterRange kRange{"length_ms", "ms", {0.1, 20.0, true}};

template <typename... Value>
std::string refusal(Value... value) {
  try {
    requireWithin(kRange, value...);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(NumberRange, HoldsItsEndsAndZeroWhereThatIsMeant) {
  const NumberRange& range = kRange.range;
  for (const double inside : {0.0, 0.1, 1.0, 20.0}) {
    EXPECT_TRUE(range.contains(inside)) << inside;
  }
  for (const double outside : {-0.1, 1e-20, 0.0999, 20.1, std::nan(""), HUGE_VAL}) {
    EXPECT_FALSE(range.contains(outside)) << outside;
  }
  EXPECT_FALSE((NumberRange{0.1, 20.0}.contains(0.0)));
  EXPECT_EQ(range.text(), "0 or 0.1..20");
  EXPECT_EQ((NumberRange{-3e15, 1e6}.text()), "-3e+15..1000000");
}

TEST(RequireWithin, NamesParameterValueAndRange) {
  EXPECT_EQ(refusal(20.0), "");
  EXPECT_EQ(refusal(20.5), "length_ms is 20.5, expected 0 or 0.1..20 [ms]");
  EXPECT_EQ(refusal(std::nan("")), "length_ms is nan, expected 0 or 0.1..20 [ms]");
}

TEST(RequireWithin, TakesAFloatThatWasRoundedFromAnEnd) {
  EXPECT_EQ(refusal(0.1F), "");
  EXPECT_EQ(refusal(20.0F), "");
  EXPECT_NE(refusal(0.0999F), "");
}

TEST(RequireWithin, ComparesDurationsToTheNanosecond) {
  constexpr std::int64_t kMs = kNanosecondsPerMillisecond;
  for (const std::int64_t inside : {std::int64_t{0}, kMs / 10, 20 * kMs}) {
    EXPECT_EQ(refusal(inside, kMs), "");
  }
  for (const std::int64_t outside :
       {std::int64_t{-1}, std::int64_t{1}, kMs / 10 - 1, 20 * kMs + 1}) {
    EXPECT_NE(refusal(outside, kMs), "") << outside;
  }
}

}  // namespace
}  // namespace fast_edi
