#include "tuning/tuning_sliders.hpp"

#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>

namespace fast_edi {
namespace {

using ::testing::ElementsAre;

std::vector<std::string> namesOf(const std::vector<Slider>& sliders) {
  std::vector<std::string> names;
  for (const Slider& slider : sliders) {
    names.push_back(slider.name());
  }
  return names;
}

// The name is no std::string, for GCC 13 takes the result for a part of one made for the call.
const Slider& find(const std::vector<Slider>& sliders, const char* name) {
  for (const Slider& slider : sliders) {
    if (slider.name() == name) {
      return slider;
    }
  }
  throw std::out_of_range(name);
}

TEST(TuningSliders, AreThresholdsExposureOffsetAndStrengths) {
  EXPECT_THAT(namesOf(tuningSliders({false, 40'000, 0.0})),
              ElementsAre("contrast_threshold_on", "contrast_threshold_off", "exposure_time_us",
                          "time_offset_us", "filter_gain_noise", "filter_gain_sigma_px",
                          "filter_gain_restore", "filter_frame_noise_kept", "filter_temporal",
                          "frame_noise_dn"));
}

TEST(TuningSliders, RangesAreThoseOfTheParameters) {
  for (const Slider& slider : tuningSliders({true, 0, 0.0})) {
    for (const ParameterDescription& parameter : parameterDescriptions()) {
      if (parameter.name != slider.name() || parameter.name == "time_offset_us") {
        continue;
      }
      EXPECT_TRUE(parameter.limits->contains(slider.value(0))) << slider.name();
      EXPECT_EQ(slider.value(slider.lastPosition()), parameter.limits->highest) << slider.name();
    }
  }
}

TEST(TuningSliders, AKnownExposureHasNone) {
  EXPECT_EQ(tuningSliders({true, 40'000, 0.0}).size(),
            tuningSliders({false, 40'000, 0.0}).size() - 1);
}

TEST(TuningSliders, AnUnknownExposureEndsWithTheLongest) {
  const std::vector<Slider> sliders = tuningSliders({false, 40'000, 0.0});
  const Slider& exposure = find(sliders, "exposure_time_us");
  EXPECT_EQ(exposure.value(0), 100.0);
  EXPECT_EQ(exposure.value(exposure.lastPosition()), 40'000.0);
  // Of a single frame, nothing is known.
  const std::vector<Slider> unknown = tuningSliders({false, 0, 0.0});
  const Slider& any = find(unknown, "exposure_time_us");
  EXPECT_EQ(any.value(any.lastPosition()), 1e6);
}

TEST(TuningSliders, TheOffsetMovesAroundItsStart) {
  for (const double start_us : {0.0, 10'240.0, -1.6e15, 3e15}) {
    const std::vector<Slider> sliders = tuningSliders({true, 0, start_us});
    const Slider& offset = find(sliders, "time_offset_us");
    EXPECT_NEAR(offset.value(offset.position(start_us)), start_us, 50.0);
    EXPECT_NEAR(offset.value(0), start_us - kOffsetRange_us, 50.0);
    EXPECT_LE(offset.value(offset.lastPosition()), 3e15);
  }
}

}  // namespace
}  // namespace fast_edi
