#include "fast_edi/base/stored_image.hpp"

#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

namespace fast_edi {
namespace {

constexpr SensorSize kSize{3, 2};

TEST(StoredImage, KeepsPixelsWithoutTheirPadding) {
  const std::vector<std::uint8_t> padded = {1, 2, 3, 99, 4, 5, 6, 99};
  StoredImage image;
  EXPECT_TRUE(image.empty());
  image.assign({padded.data(), kSize, 4, PixelFormat::kMono8});
  ASSERT_FALSE(image.empty());
  const ImageView view = image.view();
  EXPECT_EQ(view.size, kSize);
  EXPECT_EQ(view.step, 3U);
  EXPECT_EQ(std::vector<std::uint8_t>(view.data, view.data + 6),
            (std::vector<std::uint8_t>{1, 2, 3, 4, 5, 6}));
}

TEST(StoredImage, HasRoomForEachFormat) {
  for (const PixelFormat format :
       {PixelFormat::kMono8, PixelFormat::kBayer8, PixelFormat::kMono16, PixelFormat::kColour8,
        PixelFormat::kBayer16, PixelFormat::kColour16, PixelFormat::kColourAlpha8,
        PixelFormat::kColourAlpha16}) {
    StoredImage image;
    const MutableImageView room = image.reshape(kSize, format);
    EXPECT_EQ(room.format, format);
    EXPECT_EQ(room.step, static_cast<std::size_t>(3 * bytesPerPixel(format)));
    room.row(1)[room.step - 1] = 7;
    EXPECT_EQ(image.view().row(1)[room.step - 1], 7);
  }
}

TEST(StoredImage, ForgetsTheImageNotItsMemory) {
  StoredImage image;
  image.reshape(kSize, PixelFormat::kMono8);
  const std::size_t bytes = image.memoryBytes();
  EXPECT_GE(bytes, kSize.pixelCount());
  image.clear();
  EXPECT_TRUE(image.empty());
  EXPECT_EQ(image.memoryBytes(), bytes);
}

TEST(CopyPixels, LeavesPaddingAlone) {
  const std::vector<std::uint8_t> in = {1, 2, 3, 4, 5, 6};
  std::vector<std::uint8_t> out(8, 99);
  copyPixels({in.data(), kSize, 3, PixelFormat::kMono8},
             {out.data(), kSize, 4, PixelFormat::kMono8});
  EXPECT_EQ(out, (std::vector<std::uint8_t>{1, 2, 3, 99, 4, 5, 6, 99}));
}

}  // namespace
}  // namespace fast_edi
