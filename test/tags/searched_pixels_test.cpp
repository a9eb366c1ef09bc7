#include "tags/searched_pixels.hpp"

#include <vector>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "fast_edi/tags/tag_detector.hpp"
#include "tags/tag_pictures.hpp"

namespace fast_edi {
namespace {

constexpr int kMostTasksPerThread = 10;

/// Length of a task's table by the code of libapriltag 3.1.
int tableLength(cv::Size decimated, int threads) {
  const int clusters = static_cast<int>(0.2 * decimated.width * decimated.height);
  const int rows = decimated.height - 1;
  const int rows_per_task = 1 + rows / (kMostTasksPerThread * threads);
  return 2 * (clusters / (rows / rows_per_task + 1)) / 2048;
}

/// The decimated frame by the code of libapriltag 3.1.
cv::Size decimated(cv::Size size, double decimate) {
  if (decimate == 1.5) {
    return {size.width / 3 * 2, size.height / 3 * 2};
  }
  const int factor = static_cast<int>(decimate);
  return size / factor;
}

TEST(SearchedPixels, EachThreadFindsEnough) {
  for (const double decimate : {1.0, 1.5, 2.0, 3.0, 3.7, 16.0}) {
    for (const cv::Size size : {cv::Size(16, 16), cv::Size(17, 19), cv::Size(240, 180),
                                cv::Size(346, 260), cv::Size(640, 480), cv::Size(1281, 1023)}) {
      if (size.width < 16.0 * decimate) {
        continue;
      }
      const cv::Mat frame = withEnoughRows(cv::Mat(size, CV_8UC1, cv::Scalar(90)), decimate);
      EXPECT_EQ(frame.cols, size.width);
      EXPECT_GE(frame.rows, size.height);
      for (const int wanted : {1, 2, 5, 64}) {
        const int threads = threadsWithEnoughPixels(frame.size(), decimate, wanted);
        EXPECT_GE(threads, 1);
        EXPECT_LE(threads, wanted);
        EXPECT_GE(tableLength(decimated(frame.size(), decimate), threads), 1)
            << size << " decimate " << decimate << " threads " << threads;
      }
    }
  }
}

TEST(SearchedPixels, LargeFramesStayAsTheyAre) {
  const cv::Mat frame(260, 346, CV_8UC1, cv::Scalar(90));
  EXPECT_EQ(withEnoughRows(frame, 1.0).data, frame.data);
  EXPECT_EQ(threadsWithEnoughPixels({346, 260}, 1.0, 4), 1);
  EXPECT_EQ(threadsWithEnoughPixels({1280, 800}, 1.0, 4), 4);
}

TEST(SearchedPixels, TheLowestRowIsRepeatedWithoutWhatLiesBesideAView) {
  cv::Mat whole(60, 60, CV_8UC1, cv::Scalar(0));
  const cv::Mat view = whole(cv::Rect(10, 10, 30, 30));
  view.row(29).setTo(200);
  const cv::Mat enlarged = withEnoughRows(view, 1.0);
  EXPECT_EQ(cv::countNonZero(enlarged.rowRange(0, 30) != view), 0);
  EXPECT_EQ(cv::countNonZero(enlarged.rowRange(30, enlarged.rows) != 200), 0);
}

TEST(SearchedPixels, TheSameTagsAreInTheSamePlaces) {
  const cv::Mat frame = test::frameWithTag(9, test::squareAt({70.0, 70.0}, 48.0), {140, 130});
  const cv::Mat enlarged = withEnoughRows(frame, 1.0);
  ASSERT_GT(enlarged.rows, frame.rows);
  const TagDetector detector;
  const std::vector<TagDetection> before = detector.detect(frame);
  const std::vector<TagDetection> after = detector.detect(enlarged);
  ASSERT_EQ(before.size(), 1U);
  ASSERT_EQ(after.size(), 1U);
  EXPECT_EQ(after[0].id, 9);
  EXPECT_EQ(after[0].corners, before[0].corners);
}

}  // namespace
}  // namespace fast_edi
