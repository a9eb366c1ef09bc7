#include "dark_channel/blind_deblurring.hpp"

#include <gmock/gmock.h>

#include "dark_channel/blurred_textures.hpp"
#include "dark_channel/dark_channel_method.hpp"
#include "evaluation/message_of.hpp"

namespace fast_edi {
namespace {

using ::testing::HasSubstr;

constexpr int kMargin = 10;

BlindDeblurringOptions options() {
  BlindDeblurringOptions options;
  options.kernel_px = 13;
  options.weights.gradient_penalty_max = 1e3;  // a quarter less time for the same kernels
  return options;
}

class KnownBlur : public ::testing::TestWithParam<const char*> {};

TEST_P(KnownBlur, KernelIsFoundAndTheImageGains) {
  const cv::Mat sharp = sharpTexture(GetParam(), 116);
  const cv::Mat blurry = blurredTexture(sharp, shakeKernel(), kMargin);
  const cv::Mat truth = sharp(cv::Rect({kMargin, kMargin}, blurry.size()));
  double before = 0.0;
  const BlindDeblurringResult result = deblurBlindly(blurry, options(), [&](double done) {
    EXPECT_GT(done, before);
    before = done;
  });
  EXPECT_NEAR(before, 1.0, 1e-9);
  EXPECT_EQ(result.image.size(), blurry.size());
  EXPECT_NEAR(cv::sum(result.kernel)[0], 1.0, 1e-5);
  EXPECT_GE(kernelCorrelation(result.kernel, shakeKernel()), 0.8);
  EXPECT_GT(psnrAtBestShift(result.image, truth, 3), psnrAtBestShift(blurry, truth, 3) + 5.0);
}
INSTANTIATE_TEST_SUITE_P(Textures, KnownBlur, ::testing::Values("polygons", "rectangles", "discs"));

TEST(BlindDeblurring, AFlatImageStaysFlat) {
  BlindDeblurringOptions quick = options();
  quick.kernel_px = 5;
  quick.iterations = 1;
  const cv::Mat flat(24, 32, CV_8UC1, cv::Scalar(90));
  const BlindDeblurringResult result = deblurBlindly(flat, quick, [](double) {});
  EXPECT_LE(cv::norm(result.image, flat, cv::NORM_INF), 1.0);
}

TEST(BlindDeblurring, NamesWhatIsOutOfRange) {
  const auto faultOf = [](const cv::Mat& image, const BlindDeblurringOptions& given) {
    return messageOf<std::invalid_argument>([&] { deblurBlindly(image, given, [](double) {}); });
  };
  const cv::Mat image(24, 32, CV_8UC1, cv::Scalar(90));
  EXPECT_THAT(faultOf(cv::Mat(24, 32, CV_8UC3), options()), HasSubstr("one channel of 8 bits"));
  EXPECT_THAT(faultOf(cv::Mat(13, 32, CV_8UC1), options()),
              HasSubstr("an image larger than the kernel of 13 px, got one of 32x13"));
  BlindDeblurringOptions wrong = options();
  wrong.kernel_px = 12;
  EXPECT_THAT(faultOf(image, wrong), HasSubstr("odd side of at least 3 px, got 12"));
  EXPECT_THAT(messageOf<std::invalid_argument>([&] { DarkChannelMethod(wrong, [](double) {}); }),
              HasSubstr("odd side"));
  wrong = options();
  wrong.weights.gradient = 0.0;
  EXPECT_THAT(faultOf(image, wrong), HasSubstr("a weight of the gradient above 0"));
  wrong = options();
  wrong.weights.dark = -1.0;
  EXPECT_THAT(faultOf(image, wrong), HasSubstr("a weight of the dark channel of at least 0"));
}

}  // namespace
}  // namespace fast_edi
