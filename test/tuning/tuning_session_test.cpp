#include "tuning/tuning_session.hpp"

#include <string>

#include <gmock/gmock.h>

#include "tuning/tuning_sliders.hpp"

namespace fast_edi {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

constexpr int kEscape = 27;
constexpr std::size_t kOn = 0;
constexpr std::size_t kOff = 1;

TuningSession sessionOf(std::size_t frames, std::size_t frame) {
  const std::vector<std::string> overrides = {"contrast_threshold_on:=0.3",
                                              "contrast_threshold_off:=0.2"};
  YAML::Node root(YAML::NodeType::Map);
  applyOverrides(root, overrides);
  return {TunedParameters("", overrides, parametersFromYaml(root, ".")),
          tuningSliders({true, 0, 0.0}), frames, frame};
}

TEST(TuningSession, StepsThroughTheFrames) {
  TuningSession session = sessionOf(3, 1);
  EXPECT_EQ(session.press('n'), TuningEffect::kDeblur);
  EXPECT_EQ(session.frame(), 2u);
  EXPECT_EQ(session.press('n'), TuningEffect::kRedraw);
  EXPECT_EQ(session.frame(), 2u);
  EXPECT_THAT(session.message(), HasSubstr("last frame"));
  EXPECT_EQ(session.press('p'), TuningEffect::kDeblur);
  EXPECT_THAT(session.message(), IsEmpty());
  EXPECT_EQ(session.press(0xff51), TuningEffect::kDeblur);
  EXPECT_EQ(session.frame(), 0u);
  EXPECT_EQ(session.press('p'), TuningEffect::kRedraw);
  EXPECT_THAT(session.message(), HasSubstr("first frame"));
  EXPECT_EQ(session.press(0xff53), TuningEffect::kDeblur);
  EXPECT_EQ(session.frame(), 1u);
}

TEST(TuningSession, ASliderSetsItsParameter) {
  TuningSession session = sessionOf(1, 0);
  const int position = session.position(kOn);
  EXPECT_EQ(session.moveSlider(kOn, position), TuningEffect::kNone);
  EXPECT_EQ(session.value(kOn), 0.3);  // as given, though between two positions
  EXPECT_EQ(session.moveSlider(kOn, position + 5), TuningEffect::kDeblur);
  EXPECT_EQ(session.position(kOn), position + 5);
  EXPECT_EQ(session.value(kOn), session.sliders()[kOn].value(position + 5));
  EXPECT_EQ(session.parameters().loaded().deblur.thresholds.on, session.value(kOn));
  EXPECT_EQ(session.startValue(kOn), 0.3);
  // Never beyond its end.
  session.moveSlider(kOn, 1'000'000);
  EXPECT_EQ(session.value(kOn), 10.0);
  EXPECT_EQ(session.position(kOn), session.sliders()[kOn].lastPosition());
}

TEST(TuningSession, KeysMoveTheChosenSlider) {
  TuningSession session = sessionOf(1, 0);
  EXPECT_EQ(session.chosenSlider(), kOn);
  EXPECT_EQ(session.press('k'), TuningEffect::kRedraw);
  EXPECT_EQ(session.chosenSlider(), kOn);
  EXPECT_EQ(session.press('j'), TuningEffect::kRedraw);
  EXPECT_EQ(session.chosenSlider(), kOff);
  const int position = session.position(kOff);
  EXPECT_EQ(session.press('+'), TuningEffect::kMarks);
  EXPECT_EQ(session.press('='), TuningEffect::kMarks);
  EXPECT_EQ(session.press('>'), TuningEffect::kMarks);
  EXPECT_EQ(session.position(kOff), position + 12);
  EXPECT_EQ(session.press('-'), TuningEffect::kMarks);
  EXPECT_EQ(session.press('<'), TuningEffect::kMarks);
  EXPECT_EQ(session.position(kOff), position + 1);
  EXPECT_EQ(session.value(kOn), 0.3);
  EXPECT_EQ(session.press('0'), TuningEffect::kMarks);
  EXPECT_EQ(session.position(kOff), position);
  EXPECT_EQ(session.value(kOff), 0.2);
  for (std::size_t i = 0; i < 2 * session.sliders().size(); ++i) {
    session.press('j');
  }
  EXPECT_EQ(session.chosenSlider(), session.sliders().size() - 1);
}

TEST(TuningSession, OtherKeys) {
  TuningSession session = sessionOf(1, 0);
  EXPECT_EQ(session.press('s'), TuningEffect::kSave);
  EXPECT_EQ(session.press('q'), TuningEffect::kEnd);
  EXPECT_EQ(session.press(kEscape), TuningEffect::kEnd);
  EXPECT_FALSE(session.showsHelp());
  EXPECT_EQ(session.press('h'), TuningEffect::kRedraw);
  EXPECT_TRUE(session.showsHelp());
  EXPECT_EQ(session.press('h'), TuningEffect::kRedraw);
  EXPECT_FALSE(session.showsHelp());
  EXPECT_EQ(session.press('x'), TuningEffect::kRedraw);
  EXPECT_THAT(session.message(), HasSubstr("h shows the keys"));
}

TEST(TuningSession, HeldKeysDoNotCount) {
  constexpr int kNumLock = 0x100000;
  TuningSession session = sessionOf(2, 0);
  EXPECT_EQ(session.press(kNumLock | 'n'), TuningEffect::kDeblur);
  EXPECT_EQ(session.frame(), 1u);
}

TEST(TuningSession, EachKeyOfTheHelpDoesSomething) {
  for (const TuningKey& key : kTuningKeys) {
    TuningSession session = sessionOf(3, 1);
    session.press(key.keys[0]);
    EXPECT_THAT(session.message(), Not(HasSubstr("h shows the keys"))) << key.keys;
  }
}

}  // namespace
}  // namespace fast_edi
