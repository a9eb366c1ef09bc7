#include "fast_edi/messages/message_frame_sink.hpp"

#include <vector>

#include <gtest/gtest.h>
#include <boost/make_shared.hpp>

namespace fast_edi {
namespace {

struct Delivery {
  sensor_msgs::ImagePtr image;
  sensor_msgs::CameraInfoPtr info;
};

class MessageFrameSinkTest : public ::testing::Test {
 protected:
  static sensor_msgs::ImagePtr makeImage(const std::string& encoding, const std::string& frame_id) {
    auto image = boost::make_shared<sensor_msgs::Image>();
    image->header.stamp = ros::Time(100, 1);
    image->header.frame_id = frame_id;
    image->encoding = encoding;
    image->width = 2;
    image->height = 2;
    image->step = 5;
    image->data = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10};
    return image;
  }

  OutputFrame outputFor(const InputFrame& input) {
    OutputFrame output;
    output.input = input;
    output.stamp_ns = 100'000'000'077;
    return output;
  }

  std::vector<Delivery> deliveries_;
  MessageFrameSink sink_{
      "fallback", [this](const sensor_msgs::ImagePtr& image, const sensor_msgs::CameraInfoPtr& info,
                         const OutputFrame&) {
        deliveries_.push_back({image, info});
      }};
};

TEST_F(MessageFrameSinkTest, WritesIntoTheOutgoingMessage) {
  const sensor_msgs::ImagePtr message = makeImage("mono8", "camera");
  const InputFrame frame = makeInputFrame(message, readImage(*message), 42);
  EXPECT_EQ(frame.stamp_ns, 100'000'000'001);
  EXPECT_TRUE(frame.supported);
  EXPECT_EQ(messageFrame(frame).arrival_ns, 42);
  const MutableImageView view = sink_.begin(frame);
  view.row(1)[1] = 200;
  sink_.finish(outputFor(frame));
  ASSERT_EQ(deliveries_.size(), 1u);
  const sensor_msgs::Image& image = *deliveries_[0].image;
  EXPECT_EQ(image.data.data(), view.data) << "copied on the way";
  EXPECT_EQ(image.step, 2u);
  EXPECT_EQ(image.data[3], 200);
  EXPECT_EQ(image.header.stamp, ros::Time(100, 77));
  EXPECT_EQ(image.header.frame_id, "camera");
  EXPECT_EQ(deliveries_[0].info->header.stamp, image.header.stamp);
  EXPECT_EQ(deliveries_[0].info->header.frame_id, "camera");
}

TEST_F(MessageFrameSinkTest, NamesTheFrameOfImagesThatHaveNone) {
  const sensor_msgs::ImagePtr message = makeImage("mono8", "");
  const InputFrame frame = makeInputFrame(message, readImage(*message), 0);
  sink_.begin(frame);
  sink_.finish(outputFor(frame));
  EXPECT_EQ(deliveries_.at(0).image->header.frame_id, "fallback");
  EXPECT_EQ(deliveries_.at(0).info->header.frame_id, "fallback");
}

TEST_F(MessageFrameSinkTest, PassesUnsupportedImagesOnAsTheyCame) {
  const sensor_msgs::ImagePtr message = makeImage("yuv422", "camera");
  const InputFrame frame = makeInputFrame(message, readImage(*message), 0);
  EXPECT_FALSE(frame.supported);
  EXPECT_EQ(frame.image.size, SensorSize{});
  EXPECT_EQ(sink_.begin(frame).size, SensorSize{});
  sink_.finish(outputFor(frame));
  ASSERT_EQ(deliveries_.size(), 1u);
  EXPECT_EQ(deliveries_[0].image->data, message->data);
  EXPECT_EQ(deliveries_[0].image->encoding, "yuv422");
  EXPECT_EQ(deliveries_[0].image->step, 5u);
  EXPECT_EQ(deliveries_[0].image->header.stamp, ros::Time(100, 77));
  EXPECT_EQ(message->header.stamp, ros::Time(100, 1)) << "the input was written to";
}

TEST_F(MessageFrameSinkTest, DeliversLatentImagesToWhoeverWantsThem) {
  EXPECT_FALSE(sink_.wantsLatentImages());
  bool wanted = false;
  std::vector<sensor_msgs::ImagePtr> latent;
  sink_.setLatent([&wanted] { return wanted; },
                  [&latent](const sensor_msgs::ImagePtr& image) { latent.push_back(image); });
  EXPECT_FALSE(sink_.wantsLatentImages());
  wanted = true;
  EXPECT_TRUE(sink_.wantsLatentImages());
  const sensor_msgs::ImagePtr message = makeImage("mono8", "");
  const InputFrame frame = makeInputFrame(message, readImage(*message), 0);
  for (std::uint8_t i = 0; i < 2; ++i) {
    sink_.beginLatent(frame).row(0)[1] = static_cast<std::uint8_t>(200 + i);
    sink_.finishLatent(frame, 100'000'000'020 + i);
  }
  EXPECT_TRUE(deliveries_.empty());
  ASSERT_EQ(latent.size(), 2u);
  EXPECT_EQ(latent[0]->data[1], 200);
  EXPECT_EQ(latent[1]->data[1], 201);
  EXPECT_EQ(latent[1]->header.stamp, ros::Time(100, 21));
  EXPECT_EQ(latent[1]->header.frame_id, "fallback");
  EXPECT_EQ(latent[1]->encoding, "mono8");
}

TEST_F(MessageFrameSinkTest, UsesTheLatestCameraInfo) {
  const sensor_msgs::ImagePtr message = makeImage("mono8", "camera");
  const InputFrame frame = makeInputFrame(message, readImage(*message), 0);
  sink_.begin(frame);
  sink_.finish(outputFor(frame));
  auto calibration = boost::make_shared<sensor_msgs::CameraInfo>();
  calibration->K[0] = 250.0;
  sink_.setCameraInfo(calibration);
  sink_.begin(frame);
  sink_.finish(outputFor(frame));
  ASSERT_EQ(deliveries_.size(), 2u);
  EXPECT_EQ(deliveries_[0].info->K[0], 0.0);
  EXPECT_EQ(deliveries_[1].info->K[0], 250.0);
}

}  // namespace
}  // namespace fast_edi
