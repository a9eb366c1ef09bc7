#include "fast_edi/base/image_plane.hpp"

#include <cstdint>
#include <cstring>
#include <vector>

#include <gmock/gmock.h>

namespace fast_edi {
namespace {

using ::testing::ElementsAre;

constexpr SensorSize kSize{3, 2};

TEST(ImagePlane, ReadsGreyRowsThatAreFartherApart) {
  const std::vector<std::uint8_t> bytes{1, 2, 3, 99, 4, 5, 255, 99};
  for (const PixelFormat format : {PixelFormat::kMono8, PixelFormat::kBayer8}) {
    std::vector<float> plane(6);
    loadPlane({bytes.data(), kSize, 4, format}, 0, plane.data());
    EXPECT_THAT(plane, ElementsAre(1.0F, 2.0F, 3.0F, 4.0F, 5.0F, 255.0F));
  }
}

TEST(ImagePlane, ReadsOneChannelOfColours) {
  const std::vector<std::uint8_t> bytes{1,  2,  3,  4,  5,  6,  7,  8,  9,
                                        11, 12, 13, 14, 15, 16, 17, 18, 19};
  std::vector<float> plane(6);
  loadPlane({bytes.data(), kSize, 9, PixelFormat::kColour8}, 1, plane.data());
  EXPECT_THAT(plane, ElementsAre(2.0F, 5.0F, 8.0F, 12.0F, 15.0F, 18.0F));
}

TEST(ImagePlane, ReadsSixteenBits) {
  const std::vector<std::uint16_t> levels{0, 1, 256, 257, 40000, 65535};
  std::vector<float> plane(6);
  loadPlane({reinterpret_cast<const std::uint8_t*>(levels.data()), kSize, 6, PixelFormat::kMono16},
            0, plane.data());
  EXPECT_THAT(plane, ElementsAre(0.0F, 1.0F, 256.0F, 257.0F, 40000.0F, 65535.0F));
}

TEST(ImagePlane, WritesRoundedAndNothingElse) {
  std::vector<std::uint8_t> bytes(8, 99);
  const std::vector<float> plane{0.0F, 0.49F, 0.5F, 254.4F, 254.6F, 255.0F};
  storePlane(plane.data(), 0, {bytes.data(), kSize, 4, PixelFormat::kMono8});
  EXPECT_THAT(bytes, ElementsAre(0, 0, 1, 99, 254, 255, 255, 99));

  std::vector<std::uint8_t> colours(18, 99);
  storePlane(plane.data(), 2, {colours.data(), kSize, 9, PixelFormat::kColour8});
  EXPECT_THAT(colours,
              ElementsAre(99, 99, 0, 99, 99, 0, 99, 99, 1, 99, 99, 254, 99, 99, 255, 99, 99, 255));
}

TEST(ImagePlane, WritesWhatItRead) {
  for (const PixelFormat format :
       {PixelFormat::kMono8, PixelFormat::kBayer8, PixelFormat::kMono16, PixelFormat::kColour8,
        PixelFormat::kBayer16, PixelFormat::kColour16, PixelFormat::kColourAlpha8,
        PixelFormat::kColourAlpha16}) {
    const auto step = static_cast<std::size_t>(kSize.width * bytesPerPixel(format));
    std::vector<std::uint8_t> bytes;
    while (bytes.size() < 2 * step) {
      bytes.push_back(static_cast<std::uint8_t>(37 * bytes.size() + 11));
    }
    std::vector<std::uint8_t> copy(bytes.size());
    if (hasAlpha(format)) {
      copy = bytes;  // alpha is no plane: it stays what it is
    }
    std::vector<float> plane(6);
    for (int channel = 0; channel < channels(format); ++channel) {
      loadPlane({bytes.data(), kSize, step, format}, channel, plane.data());
      storePlane(plane.data(), channel, {copy.data(), kSize, step, format});
    }
    EXPECT_EQ(copy, bytes);
  }
}

}  // namespace
}  // namespace fast_edi
