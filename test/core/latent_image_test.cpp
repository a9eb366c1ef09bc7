#include "fast_edi/core/latent_image.hpp"

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

  void write(LatentImage& image) {
    const auto step = static_cast<std::size_t>(kSize.width);
    std::vector<float> working = gain;
    image.write({blurry.data(), kSize, step, PixelFormat::kMono8}, working.data(),
                CameraResponse::linear(), {latent.data(), kSize, step, PixelFormat::kMono8});
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

TEST(LatentImage, LeavesNoSpeckOfALonePixelByDefault) {
  LatentImage image{FilterParameters{}};
  Fixture f;
  f.gain[40] = 2.0F;
  f.gain[300] = 0.1F;
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
  f.write(image);
  EXPECT_EQ(f.latent[40], 100);
  parameters.enabled = false;
  image.setParameters(parameters);
  f.write(image);
  EXPECT_EQ(f.latent[40], 150);
}

TEST(LatentImage, RefusesParametersOutOfRange) {
  FilterParameters parameters;
  parameters.frame_noise_dn = 0.0;
  EXPECT_THROW(validate(parameters), std::invalid_argument);
  parameters = {};
  parameters.gain.range_log = -1.0F;
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
