#include "../../src/base/fast_log.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace fast_edi {
namespace {

TEST(FastLog, OneIsExactlyZero) {
  EXPECT_EQ(fastLog(1.0F), 0.0F);
}

TEST(FastExp, ZeroIsExactlyOne) {
  EXPECT_EQ(fastExp(0.0F), 1.0F);
}

TEST(FastLog, KeepsItsErrorOverTheWholeRangeOfGains) {
  for (float x = 1e-30F; x < 1e30F; x *= 1.0037F) {
    const double truth = std::log(static_cast<double>(x));
    EXPECT_NEAR(fastLog(x), truth, 2e-7 * std::max(1.0, std::abs(truth))) << x;
  }
}

TEST(FastExp, KeepsItsErrorOverTheWholeRangeOfLogGains) {
  for (float x = -80.0F; x <= 80.0F; x += 0.0137F) {
    const double truth = std::exp(static_cast<double>(x));
    EXPECT_NEAR(fastExp(x) / truth, 1.0, 2e-7) << x;
  }
}

}  // namespace
}  // namespace fast_edi
