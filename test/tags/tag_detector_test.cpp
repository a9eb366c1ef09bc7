#include "fast_edi/tags/tag_detector.hpp"

#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <opencv2/imgproc.hpp>

#include "evaluation/test_images.hpp"
#include "fast_edi/tags/tag_drawing.hpp"
#include "tags/tag_pictures.hpp"

namespace fast_edi {
namespace {

using ::testing::HasSubstr;

/// The message that settings are refused with.
std::string refusal(const TagDetectorSettings& settings) {
  try {
    TagDetector{settings};
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

/// Both tags of two frames side by side.
cv::Mat frameWithTwoTags() {
  cv::Mat frame;
  cv::hconcat(test::frameWithTag(7, test::squareAt({90.0, 120.0}, 48.0), {180, 200}),
              test::frameWithTag(3, test::squareAt({80.0, 70.0}, 48.0), {180, 200}), frame);
  return frame;
}

TEST(TagDetectorTest, FindsIdsAndCorners) {
  // A view from the side, with corners between pixels.
  const std::array<cv::Point2d, 4> corners = {
      {{100.3, 161.8}, {158.4, 170.2}, {163.1, 100.6}, {97.7, 95.9}}};
  const std::vector<TagDetection> tags = TagDetector().detect(test::frameWithTag(42, corners));
  ASSERT_EQ(tags.size(), 1U);
  EXPECT_EQ(tags[0].id, 42);
  EXPECT_EQ(tags[0].hamming, 0);
  EXPECT_GT(tags[0].decision_margin, 50.0);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    EXPECT_NEAR(tags[0].corners[i].x, corners[i].x, 0.2) << i;
    EXPECT_NEAR(tags[0].corners[i].y, corners[i].y, 0.2) << i;
  }
}

TEST(TagDetectorTest, TheCentreOfTheTopLeftPixelIsTheOrigin) {
  // By symmetry the middle of the frame, whatever the corners are fitted by.
  const std::vector<TagDetection> tags =
      TagDetector().detect(test::frameWithTag(5, test::squareAt({60.0, 60.0}, 64.0), {121, 121}));
  ASSERT_EQ(tags.size(), 1U);
  EXPECT_NEAR(tags[0].centre.x, 60.0, 0.1);
  EXPECT_NEAR(tags[0].centre.y, 60.0, 0.1);
}

TEST(TagDetectorTest, SortsByIdAndCountsEach) {
  const std::vector<TagDetection> tags = TagDetector().detect(frameWithTwoTags());
  ASSERT_EQ(tags.size(), 2U);
  EXPECT_EQ(tags[0].id, 3);
  EXPECT_EQ(tags[1].id, 7);
}

TEST(TagDetectorTest, FindsNothingInTextureOrStrongBlur) {
  const TagDetector detector;
  EXPECT_TRUE(detector.detect(texturedImage()).empty());
  EXPECT_TRUE(detector.detect(blurred(frameWithTwoTags(), 8.0)).empty());
}

TEST(TagDetectorTest, ReadsViewsWhoseRowsLieApart) {
  const cv::Mat frame = test::frameWithTag(11, test::squareAt({100.0, 100.0}, 48.0));
  const cv::Mat view = frame(cv::Rect(41, 41, 150, 150));
  ASSERT_FALSE(view.isContinuous());
  const std::vector<TagDetection> tags = TagDetector().detect(view);
  ASSERT_EQ(tags.size(), 1U);
  EXPECT_EQ(tags[0].id, 11);
}

TEST(TagDetectorTest, RepeatsItselfWithAnyNumberOfThreads) {
  const cv::Mat frame =
      withNoise(test::frameWithTag(5, test::squareAt({120.0, 110.0}, 48.0)), 12.0);
  TagDetectorSettings settings;
  settings.threads = 3;
  const std::vector<TagDetection> first = TagDetector().detect(frame);
  const std::vector<TagDetection> second = TagDetector(settings).detect(frame);
  ASSERT_EQ(first.size(), 1U);
  ASSERT_EQ(second.size(), 1U);
  EXPECT_EQ(first[0].corners, second[0].corners);
}

TEST(TagDetectorTest, DecimatedFramesShowLargeTagsAtTheSamePlace) {
  const cv::Mat frame = test::frameWithTag(5, test::squareAt({120.0, 110.0}, 96.0));
  TagDetectorSettings settings;
  settings.decimate = 2.0;
  const std::vector<TagDetection> tags = TagDetector(settings).detect(frame);
  ASSERT_EQ(tags.size(), 1U);
  EXPECT_NEAR(tags[0].centre.x, 120.0, 0.3);
  EXPECT_NEAR(tags[0].centre.y, 110.0, 0.3);
}

TEST(TagDetectorTest, TakesFramesOfAnySize) {
  TagDetectorSettings decimated;
  decimated.decimate = 3.0;
  const TagDetector full;
  const TagDetector third(decimated);
  for (const cv::Size size : {cv::Size(1, 1), cv::Size(3, 40), cv::Size(16, 16), cv::Size(17, 19),
                              cv::Size(40, 49), cv::Size(61, 48)}) {
    const cv::Mat frame = texturedImage(size);
    EXPECT_TRUE(full.detect(frame).empty()) << size;
    EXPECT_TRUE(third.detect(frame).empty()) << size;
  }
}

TEST(TagDetectorTest, KnowsEachFamilyThatItNames) {
  for (const char* family : kTagFamilies) {
    TagDetectorSettings settings;
    settings.family = family;
    settings.corrected_bits = 0;
#if !__has_include(<apriltag/tag36h10.h>)
    if (settings.family == "36h10") {
      EXPECT_THAT(refusal(settings), HasSubstr("36h10 needs libapriltag 3.2 or newer"));
      continue;
    }
#endif
    EXPECT_NO_THROW(TagDetector{settings}) << family;
  }
}

TEST(TagDetectorTest, AnotherFamilyIsNotMistaken) {
  TagDetectorSettings settings;
  settings.family = "25h9";
  EXPECT_TRUE(TagDetector(settings).detect(frameWithTwoTags()).empty());
}

TEST(TagDetectorTest, RefusesSettingsOutOfRange) {
  TagDetectorSettings settings;
  settings.family = "36h12";
  EXPECT_THAT(refusal(settings), HasSubstr("found \"36h12\", expected one of: 36h11, "));
  settings = {};
  settings.corrected_bits = 3;
  EXPECT_THAT(refusal(settings), HasSubstr("corrected_bits: found 3, expected 0..2"));
  settings = {};
  settings.decimate = 0.5;
  EXPECT_THAT(refusal(settings), HasSubstr("decimate"));
  settings = {};
  settings.threads = 0;
  EXPECT_THAT(refusal(settings), HasSubstr("threads: found 0, expected at least 1"));
  settings = {};
  settings.family = "Standard52h13";
  EXPECT_THAT(refusal(settings), HasSubstr("2 need tables of 3.2 GB"));
}

TEST(TagDetectorTest, RefusesColour) {
  EXPECT_THROW(TagDetector().detect(cv::Mat(20, 20, CV_8UC3)), std::invalid_argument);
  EXPECT_THROW(TagDetector().detect(cv::Mat()), std::invalid_argument);
}

TEST(TagDrawingTest, MarksTheOutlineAndItsLowerEdge) {
  TagDetection tag;
  tag.centre = {50.0, 50.0};
  tag.corners = test::squareAt(tag.centre, 60.0);
  cv::Mat picture(100, 100, CV_8UC3, cv::Scalar::all(0));
  drawTags({tag}, picture);
  EXPECT_GT(picture.at<cv::Vec3b>(20, 50)[1], 100) << "upper edge is green";
  EXPECT_GT(picture.at<cv::Vec3b>(80, 50)[2], 100) << "lower edge is red";
  EXPECT_EQ(picture.at<cv::Vec3b>(80, 50)[1], 0);
  EXPECT_EQ(picture.at<cv::Vec3b>(90, 90), cv::Vec3b(0, 0, 0));
}

}  // namespace
}  // namespace fast_edi
