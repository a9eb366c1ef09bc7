#include "bags/compressed_frames.hpp"

#include <gmock/gmock.h>
#include <rosbag/bag.h>
#include <sensor_msgs/Image.h>

#include <cstring>

#include <opencv2/imgcodecs.hpp>

#include "fast_edi/bags/bag_deserialise.hpp"
#include "fast_edi/bags/open_messages.hpp"
#include "support/temporary_directory.hpp"

namespace fast_edi {
namespace {

using ::testing::HasSubstr;
using ::testing::SizeIs;

sensor_msgs::CompressedImage compressed(const cv::Mat& pixels, const std::string& extension,
                                        const std::string& format) {
  sensor_msgs::CompressedImage message;
  message.header.stamp = ros::Time(1000, 5);
  message.header.frame_id = "davis";
  message.format = format;
  cv::imencode(extension, pixels, message.data);
  return message;
}

class CompressedFramesTest : public ::testing::Test {
 protected:
  template <typename Message>
  void record(const std::string& topic, const Message& message) {
    messages_.emplace_back([topic, message](rosbag::Bag& bag, const ros::Time& time) {
      bag.write(topic, time, message);
    });
  }

  /// All images that a tool gets of the bag.
  std::vector<sensor_msgs::Image> images() {
    const std::string path = directory_.file("frames.bag");
    {
      rosbag::Bag bag(path, rosbag::bagmode::Write);
      for (std::size_t i = 0; i < messages_.size(); ++i) {
        messages_[i](bag, ros::Time(1000 + static_cast<double>(i)));
      }
    }
    const std::unique_ptr<MessageSource> source = openMessages(path);
    std::vector<sensor_msgs::Image> images;
    BagMessage message;
    while (source->next(message)) {
      recorded_ += message.decoded ? 0 : 1;
      if (message.connection->datatype == "sensor_msgs/Image") {
        EXPECT_EQ(message.connection->topic, "/dvs/image_raw");
        images.push_back(*deserialise<sensor_msgs::Image>(message));
      }
    }
    damage_ = source->damage();
    return images;
  }

  const TemporaryDirectory directory_;
  std::vector<std::function<void(rosbag::Bag&, const ros::Time&)>> messages_;
  std::size_t recorded_ = 0;
  std::vector<BagDamage> damage_;
};

TEST_F(CompressedFramesTest, ComeDecodedBehindTheirMessage) {
  cv::Mat pixels(12, 16, CV_8UC1);
  cv::randu(pixels, 0, 255);
  record("/dvs/image_raw/compressed", compressed(pixels, ".png", "mono8; png compressed "));
  const std::vector<sensor_msgs::Image> frames = images();
  ASSERT_THAT(frames, SizeIs(1));
  EXPECT_EQ(recorded_, 1u);
  EXPECT_EQ(frames[0].header.stamp, ros::Time(1000, 5));
  EXPECT_EQ(frames[0].header.frame_id, "davis");
  EXPECT_EQ(frames[0].encoding, "mono8");
  EXPECT_EQ(frames[0].width, 16u);
  EXPECT_EQ(frames[0].height, 12u);
  EXPECT_EQ(frames[0].step, 16u);
  EXPECT_EQ(std::memcmp(frames[0].data.data(), pixels.data, pixels.total()), 0);
  EXPECT_THAT(damage_, SizeIs(0));
}

TEST_F(CompressedFramesTest, HaveTheEncodingThatWasCompressed) {
  const cv::Mat colour(1, 1, CV_8UC3, cv::Scalar(1, 2, 3));  // blue, green, red
  const cv::Mat grey(1, 1, CV_8UC1, cv::Scalar(7));
  record("/dvs/image_raw/compressed", compressed(colour, ".png", "rgb8; png compressed bgr8"));
  record("/dvs/image_raw/compressed", compressed(colour, ".png", "bgr8; png compressed bgr8"));
  record("/dvs/image_raw/compressed", compressed(colour, ".png", "png"));
  record("/dvs/image_raw/compressed", compressed(grey, ".png", "bayer_rggb8; png compressed "));
  const std::vector<sensor_msgs::Image> frames = images();
  ASSERT_THAT(frames, SizeIs(4));
  EXPECT_EQ(frames[0].encoding, "rgb8");
  EXPECT_EQ(frames[0].data, (std::vector<std::uint8_t>{3, 2, 1}));
  EXPECT_EQ(frames[1].encoding, "bgr8");
  EXPECT_EQ(frames[1].data, (std::vector<std::uint8_t>{1, 2, 3}));
  EXPECT_EQ(frames[2].encoding, "bgr8");
  EXPECT_EQ(frames[3].encoding, "bayer_rggb8");
}

TEST_F(CompressedFramesTest, OfATopicThatWasRecordedRawAreNotDecoded) {
  const cv::Mat grey(1, 1, CV_8UC1, cv::Scalar(7));
  record("/dvs/image_raw/compressed", compressed(grey, ".png", "png"));
  record("/dvs/image_raw", sensor_msgs::Image());
  EXPECT_THAT(images(), SizeIs(1));
  EXPECT_EQ(recorded_, 2u);
}

TEST_F(CompressedFramesTest, ThatCannotBeDecodedAreDamage) {
  const cv::Mat grey(1, 1, CV_8UC1, cv::Scalar(7));
  sensor_msgs::CompressedImage bad = compressed(grey, ".png", "png");
  bad.data.assign(100, 0x55);
  record("/dvs/image_raw/compressed", bad);
  record("/dvs/image_raw/compressed", compressed(grey, ".jpg", "jpeg"));
  EXPECT_THAT(images(), SizeIs(1));
  EXPECT_EQ(recorded_, 2u);
  ASSERT_THAT(damage_, SizeIs(1));
  EXPECT_THAT(damage_[0].what, HasSubstr("/dvs/image_raw/compressed: no picture in PNG or JPEG"));
  EXPECT_GT(damage_[0].offset, 0u);
}

}  // namespace
}  // namespace fast_edi
