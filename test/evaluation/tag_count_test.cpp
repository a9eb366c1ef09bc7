#include "fast_edi/evaluation/tag_count.hpp"

#include <cmath>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include <apriltag/apriltag.h>
#include <apriltag/tag36h11.h>
#include <gmock/gmock.h>
#include <opencv2/imgproc.hpp>

#include "evaluation/test_images.hpp"

namespace fast_edi {
namespace {

constexpr int kCellPx = 6;      // pixels for each cell of a drawn tag
constexpr int kTagCells = 10;   // white frame included
constexpr int kInnerCells = 8;  // the black square that corners refer to

cv::Mat drawTag(int id) {
  const std::unique_ptr<apriltag_family_t, decltype(&tag36h11_destroy)> family(tag36h11_create(),
                                                                               &tag36h11_destroy);
  const int frame = (kTagCells - kInnerCells) / 2;
  cv::Mat cells(kTagCells, kTagCells, CV_8UC1, cv::Scalar(255));
  cells(cv::Rect(frame, frame, kInnerCells, kInnerCells)).setTo(0);
  for (std::uint32_t bit = 0; bit < family->nbits; ++bit) {
    if ((family->codes[id] >> (family->nbits - 1 - bit)) & 1U) {
      cells.at<std::uint8_t>(static_cast<int>(family->bit_y[bit]) + frame,
                             static_cast<int>(family->bit_x[bit]) + frame) = 255;
    }
  }
  cv::Mat tag;
  cv::resize(cells, tag, {}, kCellPx, kCellPx, cv::INTER_NEAREST);
  return tag;
}

/// A grey frame with tags at the given places.
cv::Mat frameWithTags(const std::vector<std::pair<int, cv::Point>>& tags) {
  cv::Mat frame(260, 346, CV_8UC1, cv::Scalar(140));
  for (const auto& [id, at] : tags) {
    const cv::Mat tag = drawTag(id);
    tag.copyTo(frame(cv::Rect(at, tag.size())));
  }
  return frame;
}

TEST(TagDetectorTest, FindsIdsAndCorners) {
  const TagDetector detector;
  const std::vector<TagDetection> tags =
      detector.detect(frameWithTags({{7, {200, 120}}, {3, {40, 30}}}));
  ASSERT_EQ(tags.size(), 2U);
  EXPECT_EQ(tags[0].id, 3);
  EXPECT_EQ(tags[1].id, 7);
  EXPECT_EQ(tags[0].hamming, 0);
  EXPECT_GT(tags[0].decision_margin, 50.0);
  const double middle = kTagCells * kCellPx / 2.0;
  EXPECT_NEAR(tags[0].center.x, 40.0 + middle, 1.0);
  EXPECT_NEAR(tags[0].center.y, 30.0 + middle, 1.0);
  for (const cv::Point2d& corner : tags[0].corners) {
    EXPECT_NEAR(std::abs(corner.x - tags[0].center.x), kInnerCells * kCellPx / 2.0, 1.0);
    EXPECT_NEAR(std::abs(corner.y - tags[0].center.y), kInnerCells * kCellPx / 2.0, 1.0);
  }
}

TEST(TagDetectorTest, FindsNothingInTextureOrStrongBlur) {
  const TagDetector detector;
  EXPECT_TRUE(detector.detect(texturedImage()).empty());
  EXPECT_TRUE(detector.detect(blurred(frameWithTags({{3, {40, 30}}}), 8.0)).empty());
}

TEST(TagDetectorTest, ReadsViewsWhoseRowsLieApart) {
  const cv::Mat frame = frameWithTags({{11, {60, 60}}});
  const cv::Mat view = frame(cv::Rect(41, 41, 150, 150));
  ASSERT_FALSE(view.isContinuous());
  const TagDetector detector;
  const std::vector<TagDetection> tags = detector.detect(view);
  ASSERT_EQ(tags.size(), 1U);
  EXPECT_EQ(tags[0].id, 11);
}

TEST(TagDetectorTest, RepeatsItself) {
  const cv::Mat frame = withNoise(frameWithTags({{5, {100, 90}}}), 12.0);
  const TagDetector detector;
  const std::vector<TagDetection> first = detector.detect(frame);
  const std::vector<TagDetection> second = TagDetector().detect(frame);
  ASSERT_EQ(first.size(), 1U);
  ASSERT_EQ(second.size(), 1U);
  EXPECT_EQ(first[0].corners, second[0].corners);
}

TEST(TagDetectorTest, RefusesColour) {
  EXPECT_THROW(TagDetector().detect(cv::Mat(20, 20, CV_8UC3)), std::invalid_argument);
}

}  // namespace
}  // namespace fast_edi
