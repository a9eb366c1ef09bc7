#include "bags/recorded_frames.hpp"

#include <gmock/gmock.h>
#include <rosbag/bag.h>

#include "fast_edi/bags/bag_error.hpp"
#include "support/temporary_directory.hpp"

namespace fast_edi {
namespace {

using ::testing::HasSubstr;

sensor_msgs::Image imageOf(const std::string& encoding, std::uint32_t bytes_per_pixel, double time,
                           const std::vector<std::uint8_t>& data) {
  sensor_msgs::Image image;
  image.header.stamp = ros::Time(time);
  image.encoding = encoding;
  image.width = 2;
  image.height = 1;
  image.step = image.width * bytes_per_pixel;
  image.data = data;
  return image;
}

class RecordedFramesTest : public ::testing::Test {
 protected:
  /// Images on /a, one of them too short, one in colour, one of an encoding that is not deblurred.
  void SetUp() override {
    rosbag::Bag bag(path_, rosbag::bagmode::Write);
    const auto write = [&bag](const std::string& topic, const sensor_msgs::Image& image) {
      bag.write(topic, ros::Time(100), image);
    };
    write("/a", imageOf("mono8", 1, 1.0, {10, 20}));
    write("/a", imageOf("rgb8", 3, 2.0, {50, 50, 50, 70, 70, 70}));
    write("/a", imageOf("32FC1", 4, 3.0, std::vector<std::uint8_t>(8)));
    write("/a", imageOf("mono8", 1, 4.0, {10}));
    write("/b", imageOf("bayer_rggb8", 1, 5.0, {30, 40}));
  }

  const TemporaryDirectory directory_;
  const std::string path_ = directory_.file("frames.bag");
};

TEST_F(RecordedFramesTest, AreGreyAndByStamp) {
  const RecordedFrames frames = readFrames({path_}, "/a");
  ASSERT_EQ(frames.by_stamp.size(), 3U);
  EXPECT_EQ(frames.by_stamp.at(1'000'000'000).at<std::uint8_t>(0, 1), 20);
  EXPECT_EQ(frames.by_stamp.at(2'000'000'000).type(), CV_8UC1);
  EXPECT_EQ(frames.by_stamp.at(2'000'000'000).at<std::uint8_t>(0, 1), 70);
  EXPECT_TRUE(frames.by_stamp.at(3'000'000'000).empty());
  EXPECT_EQ(frames.malformed, 1U);
  EXPECT_TRUE(frames.damage.empty());
}

TEST_F(RecordedFramesTest, BayerStaysPhotositeByPhotosite) {
  const RecordedFrames frames = requireFrames(path_, "/b");
  EXPECT_EQ(frames.by_stamp.at(5'000'000'000).at<std::uint8_t>(0, 0), 30);
  EXPECT_EQ(frames.by_stamp.at(5'000'000'000).at<std::uint8_t>(0, 1), 40);
}

TEST_F(RecordedFramesTest, NoneOnATopicIsAFaultOnlyWhereTheyMustBeThere) {
  EXPECT_TRUE(readFrames({path_}, "/none").by_stamp.empty());
  try {
    requireFrames(path_, "/none");
    FAIL() << "expected a BagError";
  } catch (const BagError& error) {
    EXPECT_THAT(error.what(),
                HasSubstr(path_ + ": no frames on /none; topics with images: /a, /b"));
  }
}

}  // namespace
}  // namespace fast_edi
