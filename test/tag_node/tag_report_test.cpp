// What the tag detector counts. Publishing is tested with the node, see rostest/tag_detector.test.
#include "tag_node/tag_report.hpp"

#include <gtest/gtest.h>
#include <boost/smart_ptr/make_shared.hpp>

namespace fast_edi {
namespace {

class TagReportTest : public ::testing::Test {
 protected:
  TagReport report_{"/detector", "/dvs/deblurred/image_raw"};
};

TEST_F(TagReportTest, CountsFramesAndTags) {
  for (const std::size_t tags : {2U, 0U, 3U}) {
    report_.addFrame(tags);
  }
  report_.addRefusedImage("encoding \"32FC1\"");
  const TagSnapshot& totals = report_.totals();
  EXPECT_EQ(totals.frames, 3U);
  EXPECT_EQ(totals.frames_with_tags, 2U);
  EXPECT_EQ(totals.tags, 5U);
  EXPECT_EQ(totals.tags_in_last_frame, 3U);
  EXPECT_EQ(totals.frames_refused, 1U);
  EXPECT_EQ(totals.refusal, "encoding \"32FC1\"");
}

TEST_F(TagReportTest, CountsGapsInTheImages) {
  report_.startListening(10);
  for (const std::uint32_t sequence : {4U, 5U, 8U, 9U}) {
    report_.addArrival(sequence, 20 + sequence);
  }
  EXPECT_EQ(report_.totals().frame_gaps, 1U);
  EXPECT_EQ(report_.totals().listening_since_ns, 10);
  EXPECT_EQ(report_.totals().last_frame_ns, 29);
}

TEST_F(TagReportTest, CountsImagesThatComeTwice) {
  const auto first = boost::make_shared<const int>(1);
  const auto second = boost::make_shared<const int>(1);
  EXPECT_FALSE(report_.repeats(first));
  EXPECT_TRUE(report_.repeats(first));
  EXPECT_FALSE(report_.repeats(second));
  EXPECT_EQ(report_.totals().frames_repeated, 1U);
}

TEST_F(TagReportTest, ImagesThatNobodyListenedToAreNoGap) {
  report_.startListening(10);
  report_.addArrival(4, 20);
  report_.addArrival(5, 30);
  report_.startListening(40);
  EXPECT_EQ(report_.totals().last_frame_ns, 0) << "of the time before";
  report_.addArrival(50, 60);
  report_.addArrival(51, 70);
  EXPECT_EQ(report_.totals().frame_gaps, 0U);
}

TEST_F(TagReportTest, KeepsTheLastInternalError) {
  report_.addInternalError("first", 10);
  report_.addInternalError("second", 20);
  EXPECT_EQ(report_.totals().internal_errors, 2U);
  EXPECT_EQ(report_.totals().internal_error, "second");
}

}  // namespace
}  // namespace fast_edi
