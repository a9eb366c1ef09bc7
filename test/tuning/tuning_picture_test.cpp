#include "tuning/tuning_picture.hpp"

#include <gmock/gmock.h>

#include "tuning/tuning_sliders.hpp"

namespace fast_edi {
namespace {

TuningSession session() {
  const std::vector<std::string> overrides = {"contrast_threshold_on:=0.3",
                                              "contrast_threshold_off:=0.2"};
  YAML::Node root(YAML::NodeType::Map);
  applyOverrides(root, overrides);
  return {TunedParameters("", overrides, parametersFromYaml(root, ".")),
          tuningSliders({true, 0, 0.0}), 3, 1};
}

TunedFrame frame() {
  TunedFrame frame;
  frame.blurry = cv::Mat(36, 48, CV_8UC1, cv::Scalar(220));
  frame.events = cv::Mat(36, 48, CV_8UC3, cv::Scalar(0, 0, 255));
  frame.deblurred = cv::Mat(36, 48, CV_8UC3, cv::Scalar(90, 90, 90));
  frame.description = "exposure 10.00 ms, 1234 events";
  return frame;
}

int pixelsOf(const cv::Mat& picture, const cv::Scalar& colour) {
  cv::Mat same;
  cv::inRange(picture, colour, colour, same);
  return cv::countNonZero(same);
}

bool differ(const cv::Mat& a, const cv::Mat& b) {
  return a.size() != b.size() || cv::norm(a, b, cv::NORM_INF) > 0.0;
}

TEST(TuningPicture, ShowsThreePanels) {
  const cv::Mat picture = drawTuning(session(), frame());
  ASSERT_EQ(picture.type(), CV_8UC3);
  constexpr int kLeast = 320 * 200;
  EXPECT_GT(pixelsOf(picture, {220, 220, 220}), kLeast);
  EXPECT_GT(pixelsOf(picture, {0, 0, 255}), kLeast);
  EXPECT_GT(pixelsOf(picture, {90, 90, 90}), kLeast);
}

TEST(TuningPicture, ShowsValuesHelpAndMessage) {
  TuningSession changed = session();
  const cv::Mat before = drawTuning(changed, frame());
  changed.press('+');
  const cv::Mat moved = drawTuning(changed, frame());
  EXPECT_EQ(moved.size(), before.size());
  EXPECT_TRUE(differ(moved, before));
  changed.setMessage("saved");
  const cv::Mat told = drawTuning(changed, frame());
  EXPECT_TRUE(differ(told, moved));
  changed.press('h');
  EXPECT_GT(drawTuning(changed, frame()).rows, before.rows);
}

TEST(TuningPicture, WithoutOutputOrEvents) {
  TunedFrame passed = frame();
  passed.events.release();
  passed.deblurred.release();
  EXPECT_LT(pixelsOf(drawTuning(session(), passed), {90, 90, 90}), 320);  // shades of letters
}

TEST(TuningPicture, DimFramesAreShownBrighter) {
  TunedFrame dim = frame();
  dim.blurry.setTo(cv::Scalar(110));
  const cv::Mat picture = drawTuning(session(), dim);
  EXPECT_GT(pixelsOf(picture, {220, 220, 220}), 320 * 200);
  EXPECT_GT(pixelsOf(picture, {180, 180, 180}), 320 * 200);
}

TEST(TuningPicture, TheTitleSaysTheSameInShort) {
  TuningSession changed = session();
  EXPECT_EQ(tuningTitle(changed), "frame 1, contrast_threshold_on 0.3");
  changed.press('n');
  changed.press('j');
  changed.setMessage("saved");
  EXPECT_EQ(tuningTitle(changed), "frame 2, contrast_threshold_off 0.2, saved");
}

}  // namespace
}  // namespace fast_edi
