#include "calibration/learned_contrast.hpp"

#include <gmock/gmock.h>

namespace fast_edi {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const ContrastThresholds kGiven{0.26, 0.24};
constexpr std::uint64_t kFits = 20;

TEST(LearnedContrast, NearTheGivenOnesIsNoFault) {
  EXPECT_THAT(learnedContrastRemark(kGiven, kGiven, kFits), IsEmpty());
  EXPECT_THAT(learnedContrastRemark(kGiven, {0.32, 0.19}, kFits), IsEmpty());
}

TEST(LearnedContrast, OneFarAwayIsAFault) {
  for (const ContrastThresholds& learned :
       {ContrastThresholds{0.338, 0.24}, {0.182, 0.24}, {0.26, 0.312}, {0.26, 0.168}}) {
    EXPECT_THAT(learnedContrastRemark(kGiven, learned, kFits),
                AllOf(HasSubstr("0.260, 0.240 (ON, OFF) given"), HasSubstr("validate_bag"),
                      HasSubstr("tune")));
  }
}

TEST(LearnedContrast, FewPairsOfFramesSayNothing) {
  EXPECT_THAT(learnedContrastRemark(kGiven, {0.338, 0.312}, kLeastFits - 1), IsEmpty());
}

}  // namespace
}  // namespace fast_edi
