#include "fast_edi/latent/latent_image.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <vector>

namespace fast_edi {
namespace {

constexpr SensorSize kSize{32, 24};

struct Fixture {
  std::vector<std::uint8_t> blurry = std::vector<std::uint8_t>(kSize.pixelCount(), 100);
  std::vector<std::uint8_t> latent = std::vector<std::uint8_t>(kSize.pixelCount(), 0);
  std::vector<float> gain = std::vector<float>(kSize.pixelCount(), 1.0F);
  std::vector<std::uint16_t> counts = std::vector<std::uint16_t>(2 * kSize.pixelCount());

  void write(LatentImage& image) {
    const auto step = static_cast<std::size_t>(kSize.width);
    std::vector<float> working = gain;
    image.write({blurry.data(), kSize, step, PixelFormat::kMono8}, working.data(),
                {counts.data(), {0.25, 0.25}}, CameraResponse::linear(),
                {latent.data(), kSize, step, PixelFormat::kMono8});
  }
};

TEST(LatentImage, IsPlainEdiWhenTheFilterIsOff) {
  FilterParameters parameters;
  parameters.enabled = false;
  LatentImage image(parameters);
  Fixture f;
  f.gain[40] = 1.5F;
  f.gain[77] = 0.25F;
  f.write(image);
  for (std::size_t i = 0; i < f.latent.size(); ++i) {
    EXPECT_EQ(f.latent[i], i == 40 ? 150 : i == 77 ? 25 : 100) << i;
  }
}

TEST(LatentImage, LeavesNoSpeckOfHotPixelsByDefault) {
  LatentImage image{FilterParameters{}};
  Fixture f;
  f.gain[40] = 2.0F;
  f.counts[2 * 40] = 30;
  for (const std::size_t pixel : {300U, 301U}) {
    f.gain[pixel] = 0.1F;
    f.counts[2 * pixel + 1] = 30;
  }
  f.write(image);
  EXPECT_EQ(f.latent, f.blurry);
}

TEST(LatentImage, SaturatedAndBlackAreasStayFreeOfSpecks) {
  LatentImage image{FilterParameters{}};
  Fixture f;
  for (std::size_t i = 0; i < f.blurry.size(); ++i) {
    f.blurry[i] = i < f.blurry.size() / 2 ? 0 : 255;
    f.gain[i] = i % 7 == 0 ? 1.4F : 1.0F;  // noise events
  }
  f.write(image);
  for (std::size_t i = 0; i < f.latent.size(); ++i) {
    EXPECT_EQ(f.latent[i], f.blurry[i]) << i;
  }
}

TEST(LatentImage, SaturatedPixelsStaySaturatedUnlessSomethingBrightMovedAway) {
  FilterParameters parameters;
  parameters.gain.despeckle = false;
  parameters.gain.smooth = false;
  parameters.gain.restore = 0.0F;
  LatentImage image(parameters);
  Fixture f;
  f.blurry.assign(f.blurry.size(), 255);
  f.gain[40] = 0.6F;   // flicker
  f.gain[140] = 0.2F;  // moved away
  f.gain[240] = 2.0F;
  f.write(image);
  EXPECT_EQ(f.latent[40], 255);
  EXPECT_EQ(f.latent[140], 51);
  EXPECT_EQ(f.latent[240], 255);
}

TEST(LatentImage, OneSaturatedChannelIsNoSaturatedPixel) {
  FilterParameters parameters;
  parameters.gain.smooth = false;
  parameters.frame_noise = false;
  LatentImage image(parameters);
  constexpr SensorSize kOne{1, 1};
  const std::uint16_t counts[2] = {1, 0};
  for (std::size_t unsaturated = 0; unsaturated < 3; ++unsaturated) {
    std::uint8_t blurry[] = {255, 255, 255};
    blurry[unsaturated] = 200;
    std::uint8_t latent[3] = {};
    float gain = 0.6F;
    image.write({blurry, kOne, 3, PixelFormat::kColour8}, &gain, {counts, {0.25, 0.25}},
                CameraResponse::linear(), {latent, kOne, 3, PixelFormat::kColour8});
    EXPECT_LT(latent[unsaturated], 130) << unsaturated;
  }
}

TEST(LatentImage, EachPieceCanBeSwitchedOff) {
  FilterParameters parameters;
  parameters.gain.despeckle = false;
  parameters.gain.smooth = false;
  parameters.gain.restore = 0.0F;
  parameters.frame_noise = false;
  LatentImage image(parameters);
  Fixture f;
  f.gain[40] = 1.5F;
  f.write(image);
  EXPECT_EQ(f.latent[40], 150);
}

TEST(LatentImage, TakesOverNewParameters) {
  FilterParameters parameters;
  LatentImage image(parameters);
  Fixture f;
  f.gain[40] = 1.5F;
  f.counts[2 * 40 + 1] = 30;
  f.write(image);
  EXPECT_EQ(f.latent[40], 100);
  parameters.enabled = false;
  image.setParameters(parameters);
  f.write(image);
  EXPECT_EQ(f.latent[40], 150);
}

TEST(LatentImage, RefusesParametersOutOfRange) {
  FilterParameters parameters;
  parameters.frame_noise_dn = -0.1;
  EXPECT_THROW(validate(parameters), std::invalid_argument);
  parameters = {};
  parameters.gain.noise = 0.0F;
  EXPECT_THROW(validate(parameters), std::invalid_argument);
  parameters = {};
  parameters.gain.spatial_sigma_px = 0.0F;
  EXPECT_THROW(validate(parameters), std::invalid_argument);
  for (const double weight : {-0.1, 1.0, std::nan("")}) {
    parameters = {};
    parameters.temporal = weight;
    EXPECT_THROW(validate(parameters), std::invalid_argument);
  }
}

}  // namespace
}  // namespace fast_edi
