#include "fast_edi/base/image.hpp"

#include <array>

#include <gtest/gtest.h>

namespace fast_edi {
namespace {

TEST(Image, KnowsTheBytesOfAPixel) {
  EXPECT_EQ(bytesPerPixel(PixelFormat::kMono8), 1);
  EXPECT_EQ(bytesPerPixel(PixelFormat::kBayer8), 1);
  EXPECT_EQ(bytesPerPixel(PixelFormat::kMono16), 2);
  EXPECT_EQ(bytesPerPixel(PixelFormat::kColour8), 3);
  EXPECT_EQ(channels(PixelFormat::kMono16), 1);
  EXPECT_EQ(channels(PixelFormat::kColour8), 3);
  EXPECT_EQ(bytesPerPixel(PixelFormat::kBayer16), 2);
  EXPECT_EQ(bytesPerPixel(PixelFormat::kColour16), 6);
  EXPECT_EQ(bytesPerPixel(PixelFormat::kColourAlpha8), 4);
  EXPECT_EQ(bytesPerPixel(PixelFormat::kColourAlpha16), 8);
  EXPECT_EQ(channels(PixelFormat::kColourAlpha8), 3);
  EXPECT_EQ(samplesPerPixel(PixelFormat::kColourAlpha16), 4);
}

TEST(Image, GivesTheLevelOfAPixelInEightBits) {
  const std::array<std::uint8_t, 4> pixel{200, 100, 60, 255};
  EXPECT_EQ(level8(pixel.data(), PixelFormat::kColourAlpha8), 120U) << "alpha is no light";
  EXPECT_EQ(level8(pixel.data(), PixelFormat::kMono8), 200U);
  EXPECT_EQ(level8(pixel.data(), PixelFormat::kBayer8), 200U);
  EXPECT_EQ(level8(pixel.data(), PixelFormat::kColour8), 120U);
}

TEST(Image, BringsSixteenBitsToTheSameRange) {
  for (int dn = 0; dn <= 255; ++dn) {
    const int wide = dn * kDn16PerDn8;
    const std::array<std::uint8_t, 2> pixel{static_cast<std::uint8_t>(wide & 0xFF),
                                            static_cast<std::uint8_t>(wide >> 8)};
    EXPECT_EQ(level8(pixel.data(), PixelFormat::kMono16), static_cast<std::size_t>(dn));
    EXPECT_EQ(level8(pixel.data(), PixelFormat::kBayer16), static_cast<std::size_t>(dn));
    const std::array<std::uint8_t, 6> colour{pixel[0], pixel[1], pixel[0], pixel[1], 0, 0};
    EXPECT_EQ(level8(colour.data(), PixelFormat::kColour16), static_cast<std::size_t>(2 * dn / 3));
  }
}

TEST(Image, FindsRowsByTheirStep) {
  std::array<std::uint8_t, 12> memory{};
  const ImageView view{memory.data(), {4, 3}, 4, PixelFormat::kMono8};
  EXPECT_EQ(view.row(2), memory.data() + 8);
  const MutableImageView writable{memory.data(), {3, 3}, 4, PixelFormat::kMono8};
  EXPECT_EQ(writable.row(1), memory.data() + 4);
}

}  // namespace
}  // namespace fast_edi
