#include "fast_edi/filters/frame_noise_filter.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>
#include <vector>

#include "fast_edi/filters/non_local_means.hpp"

namespace fast_edi {
namespace {

constexpr SensorSize kSize{46, 34};

struct Image {
  PixelFormat format;
  std::size_t step;
  std::vector<std::uint8_t> bytes;

  explicit Image(PixelFormat pixel_format, std::size_t padding = 0)
      : format(pixel_format),
        step(static_cast<std::size_t>(kSize.width * bytesPerPixel(pixel_format)) + padding),
        bytes(step * static_cast<std::size_t>(kSize.height), 0xAA) {}
  ImageView view() const { return {bytes.data(), kSize, step, format}; }
  MutableImageView mutableView() { return {bytes.data(), kSize, step, format}; }
};

constexpr float kNoise_dn = 1.5F;
constexpr double kKept = 0.0;

std::vector<float> noEvents() {
  return std::vector<float>(kSize.pixelCount());
}

double noiseOf(const Image& image, double mean) {
  double squares = 0.0;
  for (int y = 0; y < kSize.height; ++y) {
    for (int x = 0; x < kSize.width; ++x) {
      squares += std::pow(
          image.bytes[static_cast<std::size_t>(y) * image.step + static_cast<std::size_t>(x)] -
              mean,
          2);
    }
  }
  return std::sqrt(squares / static_cast<double>(kSize.pixelCount()));
}

TEST(FrameNoiseFilter, LowersReadNoise) {
  Image image(PixelFormat::kMono8);
  std::mt19937 random(11);
  std::normal_distribution<double> read(100.0, 1.5);
  for (std::uint8_t& byte : image.bytes) {
    byte = static_cast<std::uint8_t>(std::lround(read(random)));
  }
  const double before = noiseOf(image, 100.0);
  FrameNoiseFilter filter(kSize, PixelFormat::kMono8, kKept);
  filter.apply(image.view(), kNoise_dn, noEvents().data(), image.mutableView());
  EXPECT_LT(noiseOf(image, 100.0), 0.5 * before);
}

TEST(FrameNoiseFilter, KeepsAFractionOfWhatItTakesOut) {
  Image image(PixelFormat::kMono16);
  std::mt19937 random(13);
  std::normal_distribution<double> read(100.0 * kDn16PerDn8, 1.5 * kDn16PerDn8);
  std::vector<std::uint16_t> levels(kSize.pixelCount());
  for (std::uint16_t& level : levels) {
    level = static_cast<std::uint16_t>(std::lround(read(random)));
  }
  std::memcpy(image.bytes.data(), levels.data(), image.bytes.size());
  const auto filtered = [&image](double kept) {
    Image out(PixelFormat::kMono16);
    FrameNoiseFilter filter(kSize, PixelFormat::kMono16, kept);
    filter.apply(image.view(), kNoise_dn, noEvents().data(), out.mutableView());
    std::vector<std::uint16_t> values(kSize.pixelCount());
    std::memcpy(values.data(), out.bytes.data(), out.bytes.size());
    return values;
  };
  const std::vector<std::uint16_t> clean = filtered(0.0);
  const std::vector<std::uint16_t> half = filtered(0.5);
  EXPECT_NE(clean, levels);
  EXPECT_EQ(filtered(1.0), levels);
  for (std::size_t i = 0; i < levels.size(); ++i) {
    EXPECT_NEAR(half[i], 0.5 * (clean[i] + levels[i]), 1.01) << i;
  }
}

TEST(FrameNoiseFilter, IsNonLocalMeansWithTheVarianceOfTheHeader) {
  for (const PixelFormat format : {PixelFormat::kMono8, PixelFormat::kMono16}) {
    const double dn = bytesPerPixel(format) == 2 ? kDn16PerDn8 : 1.0;
    Image image(format);
    std::mt19937 random(19);
    std::normal_distribution<double> read(100.0 * dn, 3.0 * dn);
    std::vector<float> levels(kSize.pixelCount());
    std::vector<float> counts(levels.size());
    std::vector<float> variances(levels.size());
    for (std::size_t i = 0; i < levels.size(); ++i) {
      const auto level = static_cast<std::uint16_t>(std::lround(read(random)));
      std::memcpy(&image.bytes[i * static_cast<std::size_t>(bytesPerPixel(format))], &level,
                  static_cast<std::size_t>(bytesPerPixel(format)));  // little-endian
      levels[i] = static_cast<float>(level);
      counts[i] = 0.5F * static_cast<float>(i % 5);
      const double n = counts[i];
      variances[i] =
          static_cast<float>(std::pow(1.5 * kNoise_dn * dn, 2) +
                             std::pow(0.02 * levels[i], 2) * std::min(1.0, n) * (1.0 + n / 3.0));
    }
    std::vector<float> expected(levels.size());
    NonLocalMeans(kSize, {1, 1.5F, 1}).apply(levels.data(), variances.data(), expected.data());
    FrameNoiseFilter filter(kSize, format, kKept);
    filter.apply(image.view(), kNoise_dn, counts.data(), image.mutableView());
    for (std::size_t i = 0; i < levels.size(); ++i) {
      EXPECT_NEAR(filter.clean()[i], expected[i], 1e-3 * dn) << i;
    }
  }
}

TEST(FrameNoiseFilter, LeavesEdgesAndSaturatedAreasAsTheyAre) {
  for (const PixelFormat format :
       {PixelFormat::kMono8, PixelFormat::kMono16, PixelFormat::kColour8}) {
    Image image(format);
    for (int y = 0; y < kSize.height; ++y) {
      const std::size_t half = image.step / 2 / 6 * 6;
      std::memset(image.bytes.data() + static_cast<std::size_t>(y) * image.step, 0, half);
      std::memset(image.bytes.data() + static_cast<std::size_t>(y) * image.step + half, 0xFF,
                  image.step - half);
    }
    Image out(format);
    FrameNoiseFilter filter(kSize, format, kKept);
    filter.apply(image.view(), kNoise_dn, noEvents().data(), out.mutableView());
    EXPECT_EQ(out.bytes, image.bytes) << static_cast<int>(format);
  }
}

TEST(FrameNoiseFilter, TakesOutWhatGainsMadeOfNoiseOnlyWhereThereAreEvents) {
  Image image(PixelFormat::kMono8);
  std::mt19937 random(12);
  std::normal_distribution<double> noise(150.0, 4.0);
  for (std::uint8_t& byte : image.bytes) {
    byte = static_cast<std::uint8_t>(std::lround(noise(random)));
  }
  const double before = noiseOf(image, 150.0);
  const auto after = [&image](float mean_count) {
    const std::vector<float> counts(kSize.pixelCount(), mean_count);
    Image out(PixelFormat::kMono8);
    FrameNoiseFilter filter(kSize, PixelFormat::kMono8, kKept);
    filter.apply(image.view(), 0.3F, counts.data(), out.mutableView());
    return noiseOf(out, 150.0);
  };
  EXPECT_GT(after(0.0F), 0.95 * before);
  EXPECT_LT(after(3.0F), 0.7 * before);
}

TEST(FrameNoiseFilter, SaturatedPixelsStay) {
  for (const PixelFormat format : {PixelFormat::kMono8, PixelFormat::kMono16}) {
    Image image(format);
    std::fill(image.bytes.begin(), image.bytes.end(), std::uint8_t{0xFD});
    const auto lamp = static_cast<std::size_t>(10 * bytesPerPixel(format));
    for (std::size_t i = 0; i < static_cast<std::size_t>(bytesPerPixel(format)); ++i) {
      image.bytes[lamp + i] = 0xFF;
    }
    Image out(format);
    FrameNoiseFilter filter(kSize, format, kKept);
    filter.apply(image.view(), kNoise_dn, noEvents().data(), out.mutableView());
    EXPECT_EQ(out.bytes[lamp], 0xFF);
  }
}

TEST(FrameNoiseFilter, ColoursDoNotMix) {
  Image image(PixelFormat::kColour8);
  for (std::size_t i = 0; i < image.bytes.size(); ++i) {
    image.bytes[i] = static_cast<std::uint8_t>(100 + i % 3);
  }
  Image out(PixelFormat::kColour8);
  FrameNoiseFilter filter(kSize, PixelFormat::kColour8, kKept);
  filter.apply(image.view(), kNoise_dn, noEvents().data(), out.mutableView());
  EXPECT_EQ(out.bytes, image.bytes);
}

TEST(FrameNoiseFilter, TheMosaicOfABayerFrameStays) {
  Image image(PixelFormat::kBayer8);
  for (int y = 0; y < kSize.height; ++y) {
    for (int x = 0; x < kSize.width; ++x) {
      image.bytes[static_cast<std::size_t>(y) * image.step + static_cast<std::size_t>(x)] =
          static_cast<std::uint8_t>(100 + 2 * (y % 2) + x % 2);
    }
  }
  Image out(PixelFormat::kBayer8);
  FrameNoiseFilter filter(kSize, PixelFormat::kBayer8, kKept);
  filter.apply(image.view(), kNoise_dn, noEvents().data(), out.mutableView());
  EXPECT_EQ(out.bytes, image.bytes);
}

TEST(FrameNoiseFilter, ReadsPaddedRowsAndWritesNothingIntoPadding) {
  Image image(PixelFormat::kMono8, 5);
  Image out(PixelFormat::kMono8, 9);
  FrameNoiseFilter filter(kSize, PixelFormat::kMono8, kKept);
  filter.apply(image.view(), kNoise_dn, noEvents().data(), out.mutableView());
  for (int y = 0; y < kSize.height; ++y) {
    for (std::size_t x = static_cast<std::size_t>(kSize.width); x < out.step; ++x) {
      EXPECT_EQ(out.bytes[static_cast<std::size_t>(y) * out.step + x], 0xAA);
    }
  }
}

}  // namespace
}  // namespace fast_edi
