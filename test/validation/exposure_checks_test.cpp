// The exposure topic by itself.
#include "validation/exposure_checks.hpp"

#include <gmock/gmock.h>

#include "validation/synthetic_recording.hpp"

namespace fast_edi {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using testing::namesOf;
using testing::SyntheticRecording;

std::vector<std::string> findingsOf(const std::function<std::int32_t(int)>& exposure_us) {
  SyntheticRecording recording;
  recording.frames = 20;
  recording.exposure_us = exposure_us;
  return namesOf(checkExposures(recording.run()));
}

TEST(ExposureChecksTest, OneMessageForEachFrameIsSound) {
  EXPECT_THAT(findingsOf([](int) { return 20'000; }), IsEmpty());
  EXPECT_THAT(findingsOf([](int i) { return i == 0 ? -1 : 20'000; }), IsEmpty());
}

TEST(ExposureChecksTest, FaultsAreNamed) {
  EXPECT_THAT(findingsOf([](int) { return -1; }), ElementsAre("exposure-missing"));
  EXPECT_THAT(findingsOf([](int) { return 20; }), ElementsAre("exposure-implausible"));
  EXPECT_THAT(findingsOf([](int) { return 60'000; }), ElementsAre("exposure-implausible"));
  EXPECT_THAT(findingsOf([](int i) { return i == 5 ? 0 : 20'000; }),
              ElementsAre("exposure-refused"));
  EXPECT_THAT(findingsOf([](int i) { return i % 3 == 1 ? -1 : 20'000; }),
              ElementsAre("exposure-count"));
}

TEST(ExposureChecksTest, AParameterTakesTheTopicsPlace) {
  SyntheticRecording recording;
  recording.exposure_us = [](int) { return -1; };
  recording.parameters.exposure_time_ns = 20 * SyntheticRecording::kMs;
  EXPECT_THAT(checkExposures(recording.run()), IsEmpty());
}

}  // namespace
}  // namespace fast_edi
