#include "networks/single_image_network.hpp"

#include <fstream>
#include <limits>
#include <stdexcept>

#include <gmock/gmock.h>

#include "evaluation/message_of.hpp"
#include "networks/network_method.hpp"
#include "networks/onnx_model.hpp"
#include "support/temporary_directory.hpp"

namespace fast_edi {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class SingleImageNetworkTest : public ::testing::Test {
 protected:
  std::string written(const std::string& content) const {
    std::ofstream(path_, std::ios::binary) << content;
    return path_;
  }
  std::string loadingFault(const std::string& path) const {
    return messageOf<std::runtime_error>([&] { SingleImageNetwork(path, {}); });
  }
  std::string runningFault(const ConvolutionModel& model) const {
    SingleImageNetwork network(written(model.bytes()), {});
    return messageOf<std::runtime_error>([&] { network.run(image_); });
  }

  const TemporaryDirectory directory_;
  const std::string path_ = directory_.file("net.onnx");
  cv::Mat image_ = [] {
    cv::Mat image(37, 45, CV_8UC1);
    cv::RNG random(1);
    random.fill(image, cv::RNG::UNIFORM, 0, 256);
    return image;
  }();
};

TEST_F(SingleImageNetworkTest, OneAndThreeChannelsInAndOut) {
  for (const int channels : {1, 3}) {
    for (const int output_channels : {1, 3}) {
      ConvolutionModel model;
      model.channels = channels;
      model.output_channels = output_channels;
      model.weight = 1.0F / static_cast<float>(channels);
      SingleImageNetwork network(written(model.bytes()), {});
      const cv::Mat result = network.run(image_);
      ASSERT_EQ(result.type(), CV_8UC1);
      ASSERT_EQ(result.size(), image_.size()) << "padded and cut back";
      EXPECT_EQ(cv::norm(result, image_, cv::NORM_INF), 0.0) << channels << output_channels;
    }
  }
}

TEST_F(SingleImageNetworkTest, ValuesAreThoseOfTheRange) {
  ConvolutionModel model;
  model.weight = 0.5F;
  // Half of 0..1 is half of the grey; half of -1..1 is half of the contrast.
  const cv::Mat flat(40, 40, CV_8UC1, cv::Scalar(200));
  EXPECT_EQ(SingleImageNetwork(written(model.bytes()), {}).run(flat).at<std::uint8_t>(20, 20), 100);
  EXPECT_NEAR(
      SingleImageNetwork(written(model.bytes()), {-1.0, 1.0}).run(flat).at<std::uint8_t>(20, 20),
      127.5 + 72.5 / 2.0, 1.0);
  model.weight = 9.0F;
  EXPECT_EQ(SingleImageNetwork(written(model.bytes()), {}).run(flat).at<std::uint8_t>(20, 20), 255);
}

TEST_F(SingleImageNetworkTest, AFixedSizeIsPaddedTo) {
  ConvolutionModel model;
  model.height = 50;
  model.width = 46;
  SingleImageNetwork network(written(model.bytes()), {});
  EXPECT_EQ(cv::norm(network.run(image_), image_, cv::NORM_INF), 0.0);
  model.width = 40;
  EXPECT_THAT(runningFault(model),
              AllOf(HasSubstr(path_), HasSubstr("takes images of 40x50, got one of 45x37")));
}

TEST_F(SingleImageNetworkTest, OutputsThatAreNoImageAreNamed) {
  ConvolutionModel smaller;
  smaller.padding = 0;
  EXPECT_THAT(runningFault(smaller),
              HasSubstr("its output is 1x1x62x62, expected 1x1x64x64 or the same with 3 channels"));
  ConvolutionModel features;
  features.output_channels = 2;
  EXPECT_THAT(runningFault(features), HasSubstr("its output is 1x2x64x64"));
  ConvolutionModel infinite;
  infinite.weight = std::numeric_limits<float>::infinity();
  EXPECT_THAT(runningFault(infinite), HasSubstr("not finite"));
}

TEST_F(SingleImageNetworkTest, AWrongOrMissingModelIsNamed) {
  EXPECT_THAT(loadingFault("/nonexistent.onnx"), HasSubstr("/nonexistent.onnx: cannot be read"));
  EXPECT_THAT(loadingFault(directory_.file("")), HasSubstr("cannot be read"));
  EXPECT_THAT(loadingFault(written("no model")), HasSubstr(path_ + ": not an ONNX model"));
  ConvolutionModel events;
  events.channels = 6;
  EXPECT_THAT(loadingFault(written(events.bytes())),
              HasSubstr("takes 6 channels, expected 1 or 3"));
  const std::string unknown =
      ProtoMessage()
          .message(
              7,
              ProtoMessage()
                  .message(1,
                           ProtoMessage().text(1, "image").text(2, "result").text(4, "NoSuchLayer"))
                  .message(11, valueInfo("image", {1, 1, 0, 0})))
          .bytes();
  EXPECT_THAT(loadingFault(written(unknown)), HasSubstr(path_));
}

TEST_F(SingleImageNetworkTest, IsAMethodWithARunTime) {
  NetworkMethod method("net", written(ConvolutionModel().bytes()), {});
  const OtherMethod::Result result = method.deblur({0, 0, image_});
  EXPECT_EQ(method.name(), "net");
  EXPECT_EQ(cv::norm(result.image, image_, cv::NORM_INF), 0.0);
  EXPECT_GT(result.runtime_ms, 0.0);
}

TEST(NetworkRangeTest, IsTwoNumbers) {
  EXPECT_EQ(networkRange("-1:1").black, -1.0);
  EXPECT_EQ(networkRange("0:255").white, 255.0);
  for (const char* text : {"", "1", "0:", "0:1:2", "0-1", "1:1", "a:b", "0:1x"}) {
    EXPECT_THAT(messageOf<std::invalid_argument>([&] { networkRange(text); }),
                HasSubstr("expected BLACK:WHITE"))
        << text;
  }
}

}  // namespace
}  // namespace fast_edi
