#include "reblur/log_levels.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace fast_edi {
namespace {

TEST(LogLevels, AreFiniteForTheDarkestAndRiseWithTheLevel) {
  constexpr float kOffset_dn = 2.0F;
  const std::vector<float> level = {-5.0F, 0.0F, 1.0F, 17.0F, 100.0F, 255.0F};
  std::vector<float> log(level.size());
  logLevels(level.data(), level.size(), kOffset_dn, log.data());
  EXPECT_EQ(log[0], log[1]);  // below black is black
  for (std::size_t i = 1; i < level.size(); ++i) {
    EXPECT_NEAR(log[i], std::log(level[i] + kOffset_dn + 3.0F), 1e-4F) << level[i];
  }
}

}  // namespace
}  // namespace fast_edi
