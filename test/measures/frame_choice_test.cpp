#include "measures/frame_choice.hpp"

#include <stdexcept>

#include <gtest/gtest.h>

namespace fast_edi {
namespace {

TEST(FrameChoice, IsAllFramesOrThoseOfItsRanges) {
  EXPECT_TRUE(FrameChoice().contains(1));
  const FrameChoice choice("3-5,9");
  for (const int number : {3, 4, 5, 9}) {
    EXPECT_TRUE(choice.contains(number)) << number;
  }
  for (const int number : {1, 2, 6, 8, 10}) {
    EXPECT_FALSE(choice.contains(number)) << number;
  }
}

TEST(FrameChoice, RefusesAnythingElse) {
  for (const char* text : {"", "0", "-3", "5-3", "3-", "a", "3,,4", "3,", "3.5", "3 4"}) {
    EXPECT_THROW(FrameChoice{text}, std::invalid_argument) << text;
  }
}

}  // namespace
}  // namespace fast_edi
