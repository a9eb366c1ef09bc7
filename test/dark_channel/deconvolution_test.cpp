#include "dark_channel/deconvolution.hpp"

#include <gtest/gtest.h>

#include "dark_channel/blurred_textures.hpp"
#include "dark_channel/periodic_image.hpp"

namespace fast_edi {
namespace {

TEST(Deconvolve, UndoesAKnownBlur) {
  constexpr int kMargin = 10;
  constexpr double kWeight = 0.002;
  for (const char* kind : {"polygons", "rectangles", "discs"}) {
    const cv::Mat sharp = sharpTexture(kind, 116);
    const cv::Mat blurry = blurredTexture(sharp, shakeKernel(), kMargin);
    const cv::Mat truth = sharp(cv::Rect({kMargin, kMargin}, blurry.size()));
    cv::Mat1f image;
    blurry.convertTo(image, CV_32F, 1.0 / 255.0);
    cv::Mat latent;
    deconvolve(periodicImage(image, 13), shakeKernel(), kWeight)(cv::Rect({0, 0}, blurry.size()))
        .convertTo(latent, CV_8U, 255.0);
    EXPECT_GT(psnrAtBestShift(latent, truth, 0), psnrAtBestShift(blurry, truth, 0) + 12.0) << kind;
  }
}

TEST(Deconvolve, LeavesAFlatImage) {
  const cv::Mat1f flat(20, 20, 0.4F);
  EXPECT_LT(cv::norm(deconvolve(flat, shakeKernel(), 0.002), flat, cv::NORM_INF), 1e-4);
}

}  // namespace
}  // namespace fast_edi
