#include "config/nearest_key.hpp"

#include <gtest/gtest.h>

namespace fast_edi {
namespace {

TEST(EditDistance, IsTwoForEachLetterThatComesOrGoes) {
  EXPECT_EQ(editDistance("", ""), 0U);
  EXPECT_EQ(editDistance("lazy", "lazy"), 0U);
  EXPECT_EQ(editDistance("", "abc"), 6U);
  EXPECT_EQ(editDistance("abc", ""), 6U);
  EXPECT_EQ(editDistance("famly", "family"), 2U);
  EXPECT_EQ(editDistance("family", "famly"), 2U);
  EXPECT_EQ(editDistance("ab", "ba"), 4U);
}

TEST(EditDistance, AnotherLetterIsOneThatGoesAndOneThatComes) {
  EXPECT_EQ(editDistance("gain", "gaie"), 4U);
  EXPECT_EQ(editDistance("x", "y"), 4U);
}

TEST(EditDistance, AnotherCaseIsHalfALetter) {
  EXPECT_EQ(editDistance("ONBn", "OnBn"), 1U);
  EXPECT_EQ(editDistance("ONBN", "OnBn"), 2U);
}

TEST(NearestKey, IsTheFirstOfThoseThatAreNearest) {
  EXPECT_EQ(nearestKey("filte", {"film", "filter", "fil"}), "filter");
  EXPECT_EQ(nearestKey("ab", {"xyz", "abc", "abd"}), "abc");
}

}  // namespace
}  // namespace fast_edi
