#include "tuning/slider.hpp"

#include <stdexcept>

#include <gmock/gmock.h>

#include "fast_edi/base/number_text.hpp"

namespace fast_edi {
namespace {

ParameterDescription parameterOf(NumberRange limits) {
  ParameterDescription parameter;
  parameter.name = "name";
  parameter.unit = "us";
  parameter.limits = limits;
  return parameter;
}

TEST(Slider, LinearPositionsAreSteps) {
  const Slider slider(parameterOf({-50'000.0, 50'000.0}), SliderScale::kLinear, 100.0);
  EXPECT_EQ(slider.name(), "name");
  EXPECT_EQ(slider.unit(), "us");
  EXPECT_EQ(slider.lastPosition(), 1000);
  EXPECT_EQ(slider.value(0), -50'000.0);
  EXPECT_EQ(slider.value(500), 0.0);
  EXPECT_EQ(slider.value(1000), 50'000.0);
  EXPECT_EQ(slider.position(149.0), 501);
}

TEST(Slider, LogarithmicPositionsAreShares) {
  const Slider slider(parameterOf({0.01, 10.0}), SliderScale::kLogarithmic, 0.02);
  EXPECT_EQ(slider.value(0), 0.01);
  EXPECT_EQ(slider.value(slider.lastPosition()), 10.0);
  EXPECT_NEAR(slider.value(101) / slider.value(100), 1.02, 0.01);
  EXPECT_NEAR(slider.value(slider.position(0.26)), 0.26, 0.26 * 0.01);
}

TEST(Slider, EachPositionIsThatOfItsValue) {
  for (const Slider& slider :
       {Slider(parameterOf({0.01, 10.0}), SliderScale::kLogarithmic, 0.02),
        Slider(parameterOf({0.01, 50.0, true}), SliderScale::kLogarithmic, 0.05),
        Slider(parameterOf({0.0, 0.9}), SliderScale::kLinear, 0.01),
        Slider(parameterOf({100.0, 39'950.0}), SliderScale::kLinear, 100.0)}) {
    for (int position = 0; position <= slider.lastPosition(); ++position) {
      EXPECT_EQ(slider.position(slider.value(position)), position) << slider.value(position);
    }
  }
}

TEST(Slider, ValuesAreShort) {
  const Slider logarithmic(parameterOf({0.01, 10.0}), SliderScale::kLogarithmic, 0.02);
  const Slider linear(parameterOf({0.0, 1.0}), SliderScale::kLinear, 0.01);
  for (int position = 0; position <= 100; ++position) {
    EXPECT_LE(exactText(logarithmic.value(position)).size(), 6u);
    EXPECT_LE(exactText(linear.value(position)).size(), 4u);
  }
}

TEST(Slider, ZeroBesidesTheLimitsIsTheFirstPosition) {
  const Slider slider(parameterOf({0.01, 50.0, true}), SliderScale::kLogarithmic, 0.05);
  EXPECT_EQ(slider.value(0), 0.0);
  EXPECT_EQ(slider.value(1), 0.01);
  EXPECT_EQ(slider.position(0.0), 0);
  EXPECT_EQ(slider.position(0.01), 1);
  EXPECT_EQ(slider.value(slider.lastPosition()), 50.0);
}

TEST(Slider, StaysWithinTheLimits) {
  const Slider slider(parameterOf({0.01, 10.0}), SliderScale::kLogarithmic, 0.02);
  EXPECT_EQ(slider.value(-5), 0.01);
  EXPECT_EQ(slider.value(1'000'000), 10.0);
  EXPECT_EQ(slider.position(0.0), 0);
  EXPECT_EQ(slider.position(1e9), slider.lastPosition());
  // Steps that do not end at the limit.
  const Slider coarse(parameterOf({0.0, 1.0}), SliderScale::kLinear, 0.3);
  EXPECT_EQ(coarse.lastPosition(), 4);
  EXPECT_EQ(coarse.value(4), 1.0);
}

TEST(Slider, RefusesWhatIsNoRange) {
  ParameterDescription text;
  text.name = "frame_id";
  EXPECT_THROW(Slider(text, SliderScale::kLinear, 1.0), std::invalid_argument);
  EXPECT_THROW(Slider(parameterOf({0.0, 1.0}), SliderScale::kLogarithmic, 0.1),
               std::invalid_argument);
  EXPECT_THROW(Slider(parameterOf({0.0, 1.0}), SliderScale::kLinear, 0.0), std::invalid_argument);
  EXPECT_THROW(Slider(parameterOf({1.0, 1.0}), SliderScale::kLinear, 0.1), std::invalid_argument);
}

}  // namespace
}  // namespace fast_edi
