/// Colour, Bayer and 16-bit recordings through the program `deblur_bag`.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include <boost/make_shared.hpp>

#include "rostest/driver_shape.hpp"
#include "support/command.hpp"
#include "support/temporary_directory.hpp"

namespace fast_edi {
namespace {

using sensor_msgs::Image;
using sensor_msgs::ImageConstPtr;
using test::Output;
using test::Recording;
using test::SimulatedRecording;

constexpr std::size_t kMaxChannels = 4;

SimulatedRecording simulate(const std::string& encoding) {
  return test::simulateRecording(
      FAST_EDI_TOOLS_DIR, test::davisRosDriver(),
      "--width 128 --height 96 --frames 4 --density 1 --exposure-us 25000 --encoding " + encoding);
}

std::vector<Output> deblur(const Recording& recording) {
  const TemporaryDirectory directory;
  test::writeBag(recording, test::davisRosDriver(), directory.file("in.bag"));
  const testing::CommandResult result = testing::runCommand(
      FAST_EDI_TOOLS_DIR "/deblur_bag --in " + directory.file("in.bag") + " --out " +
      directory.file("out.bag") + " --config " FAST_EDI_SOURCE_DIR "/cfg/davis346.yaml");
  if (result.exit_code != 0) {
    throw std::runtime_error(result.output);
  }
  return test::readOutputs(directory.file("out.bag"), "/dvs/deblurred");
}

/// Colour of a sample: the channel, or the place in the Bayer pattern.
std::size_t channelOf(const Image& image, std::size_t sample) {
  if (image.encoding == "rgb8" || image.encoding == "bgr8") {
    return sample % 3;
  }
  if (image.encoding.rfind("bayer", 0) == 0) {
    return sample / image.width % 2 * 2 + sample % image.width % 2;
  }
  return 0;
}

double sampleAt(const Image& image, std::size_t sample) {
  if (image.encoding != "mono16") {
    return image.data[sample];
  }
  std::uint16_t value = 0;
  std::memcpy(&value, image.data.data() + sample * sizeof(value), sizeof(value));
  return value / 257.0;
}

struct ChannelErrors {
  std::array<double, kMaxChannels> mean{};    ///< of image minus truth [DN]
  std::array<double, kMaxChannels> square{};  ///< mean square of it [DN^2]; 0: no such channel
  std::array<double, kMaxChannels> truth{};   ///< mean of the truth [DN]
};

ChannelErrors errorsOf(const Image& image, const Image& truth) {
  ChannelErrors errors;
  std::array<double, kMaxChannels> count{};
  const std::size_t samples = truth.data.size() / (truth.encoding == "mono16" ? 2 : 1);
  for (std::size_t i = 0; i < samples; ++i) {
    const std::size_t channel = channelOf(truth, i);
    const double difference = sampleAt(image, i) - sampleAt(truth, i);
    errors.mean[channel] += difference;
    errors.square[channel] += difference * difference;
    errors.truth[channel] += sampleAt(truth, i);
    ++count[channel];
  }
  for (std::size_t channel = 0; channel < kMaxChannels && count[channel] > 0.0; ++channel) {
    errors.mean[channel] /= count[channel];
    errors.square[channel] /= count[channel];
    errors.truth[channel] /= count[channel];
  }
  return errors;
}

class DeblurBagEncoding : public ::testing::TestWithParam<const char*> {};

TEST_P(DeblurBagEncoding, KeepsColoursAndSharpensEachOfThem) {
  const SimulatedRecording simulated = simulate(GetParam());
  const std::vector<ImageConstPtr> inputs = test::imagesOf(simulated.recording);
  const std::vector<Output> outputs = deblur(simulated.recording);
  ASSERT_EQ(outputs.size(), simulated.truth.size());
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    SCOPED_TRACE(i);
    const Image& output = *outputs[i].image;
    const Image& truth = *simulated.truth[i];
    EXPECT_EQ(output.encoding, GetParam());
    EXPECT_EQ(output.step, truth.step);
    EXPECT_EQ(output.header.stamp, truth.header.stamp);
    ASSERT_EQ(output.data.size(), truth.data.size());
    const ChannelErrors blurry = errorsOf(*inputs[i], truth);
    const ChannelErrors deblurred = errorsOf(output, truth);
    for (std::size_t channel = 0; channel < kMaxChannels; ++channel) {
      EXPECT_LT(std::abs(deblurred.mean[channel]), 2.0) << "channel " << channel;
      // 3 dB
      EXPECT_LE(deblurred.square[channel], 0.5 * blurry.square[channel]) << "channel " << channel;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, DeblurBagEncoding,
                         ::testing::Values("mono16", "bayer_rggb8", "rgb8", "bgr8"));

TEST(DeblurBagColour, RedAndBlueStayWhatTheyAre) {
  const SimulatedRecording rgb = simulate("rgb8");
  const ChannelErrors truth = errorsOf(*rgb.truth[0], *rgb.truth[0]);
  ASSERT_GT(std::abs(truth.truth[0] - truth.truth[2]), 3.0) << "a scene without colours";
  const std::vector<Output> red_first = deblur(rgb.recording);
  const std::vector<Output> blue_first = deblur(simulate("bgr8").recording);
  ASSERT_EQ(red_first.size(), blue_first.size());
  for (std::size_t i = 0; i < red_first.size(); ++i) {
    const std::vector<std::uint8_t>& a = red_first[i].image->data;
    const std::vector<std::uint8_t>& b = blue_first[i].image->data;
    ASSERT_EQ(a.size(), b.size());
    std::size_t different = 0;
    for (std::size_t k = 0; k < a.size(); k += 3) {
      different += a[k] != b[k + 2] || a[k + 1] != b[k + 1] || a[k + 2] != b[k] ? 1 : 0;
    }
    EXPECT_EQ(different, 0u) << "frame " << i;
  }
}

TEST(DeblurBagColour, EveryBayerPatternIsTakenAlike) {
  const SimulatedRecording simulated = simulate("bayer_rggb8");
  const std::vector<Output> expected = deblur(simulated.recording);
  for (const char* pattern : {"bayer_bggr8", "bayer_gbrg8", "bayer_grbg8"}) {
    Recording renamed = simulated.recording;
    for (test::Arrival& arrival : renamed) {
      if (arrival.image) {
        auto image = boost::make_shared<Image>(*arrival.image);
        image->encoding = pattern;
        arrival.image = image;
      }
    }
    const std::vector<Output> outputs = deblur(renamed);
    ASSERT_EQ(outputs.size(), expected.size());
    for (std::size_t i = 0; i < outputs.size(); ++i) {
      EXPECT_EQ(outputs[i].image->encoding, pattern);
      EXPECT_TRUE(outputs[i].image->data == expected[i].image->data) << pattern << " " << i;
    }
  }
}

}  // namespace
}  // namespace fast_edi
