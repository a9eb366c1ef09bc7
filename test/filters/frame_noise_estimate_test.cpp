#include "fast_edi/filters/frame_noise_estimate.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>
#include <vector>

namespace fast_edi {
namespace {

constexpr SensorSize kSize{346, 260};

struct Frame {
  PixelFormat format;
  std::size_t step;
  std::vector<std::uint8_t> bytes;

  explicit Frame(PixelFormat pixel_format)
      : format(pixel_format),
        step(static_cast<std::size_t>(kSize.width * bytesPerPixel(pixel_format))),
        bytes(step * static_cast<std::size_t>(kSize.height)) {}
  ImageView view() const { return {bytes.data(), kSize, step, format}; }
};

/// A smooth slope with noise; a Bayer mosaic has other levels at every second pixel.
Frame noisyFrame(PixelFormat format, double sigma_dn, unsigned seed) {
  Frame frame(format);
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0.0, sigma_dn);
  const int samples = channels(format);
  for (int y = 0; y < kSize.height; ++y) {
    for (int x = 0; x < kSize.width; ++x) {
      for (int channel = 0; channel < samples; ++channel) {
        double level = 60.0 + 0.2 * x + 0.1 * y + 10.0 * channel + noise(random);
        if (format == PixelFormat::kBayer8) {
          level += 30.0 * (x % 2) + 15.0 * (y % 2);
        }
        std::uint8_t* row = frame.bytes.data() + static_cast<std::size_t>(y) * frame.step;
        if (format == PixelFormat::kMono16) {
          const auto dn = static_cast<std::uint16_t>(std::lround(level * kDn16PerDn8));
          std::memcpy(row + 2 * x, &dn, sizeof(dn));
        } else {
          row[x * samples + channel] = static_cast<std::uint8_t>(std::lround(level));
        }
      }
    }
  }
  return frame;
}

TEST(FrameNoiseEstimate, IsWithinATenthOfTheTruthInEveryFormat) {
  for (const PixelFormat format :
       {PixelFormat::kMono8, PixelFormat::kMono16, PixelFormat::kColour8, PixelFormat::kBayer8}) {
    for (const double sigma : {1.0, 2.0, 4.0}) {
      FrameNoiseEstimate estimate;
      EXPECT_NEAR(static_cast<double>(estimate.of(noisyFrame(format, sigma, 3).view())), sigma,
                  0.1 * sigma)
          << static_cast<int>(format);
    }
  }
}

/// As the header says it, in double precision; of a frame of one byte a sample.
double slowEstimate(const ImageView& frame) {
  constexpr int kBlock = 8;
  const int stride = isBayer(frame.format) ? 2 : 1;
  const int samples = channels(frame.format);
  std::vector<double> means;
  for (int channel = 0; channel < samples; ++channel) {
    const auto at = [&](int x, int y) {
      return static_cast<double>(frame.data[static_cast<std::size_t>(y) * frame.step +
                                            static_cast<std::size_t>(x * samples + channel)]);
    };
    for (int top = 0; top + kBlock <= frame.size.height; top += kBlock) {
      for (int left = 0; left + kBlock + 2 * stride <= frame.size.width; left += kBlock) {
        double sum = 0.0;
        bool judged = true;
        for (int y = top; y < top + kBlock; ++y) {
          for (int x = left; x < left + kBlock; ++x) {
            sum += std::abs(at(x, y) - 2.0 * at(x + stride, y) + at(x + 2 * stride, y));
            for (const int of : {x, x + 2 * stride}) {
              judged = judged && at(of, y) > 0.0 && at(of, y) < 255.0;
            }
          }
        }
        if (judged) means.push_back(sum / (kBlock * kBlock));
      }
    }
  }
  if (means.empty()) return static_cast<double>(FrameNoiseEstimate::kLowest_dn);
  std::sort(means.begin(), means.end());
  // 8 % lower than the mean of all: blocks scatter.
  const double sigma = means[(means.size() - 1) / 5] / (std::sqrt(12.0 / std::acos(-1.0)) * 0.92);
  return std::clamp(sigma, static_cast<double>(FrameNoiseEstimate::kLowest_dn),
                    static_cast<double>(FrameNoiseEstimate::kHighest_dn));
}

/// Frames that just hold one block, or two, or are a column or row too small, with noise that
/// differs from block to block and levels that are cut off here and there.
TEST(FrameNoiseEstimate, IsTheOneOfASlowReference) {
  std::mt19937 random(11);
  FrameNoiseEstimate estimate;
  int judged = 0;
  for (const PixelFormat format :
       {PixelFormat::kMono8, PixelFormat::kColour8, PixelFormat::kBayer8}) {
    for (const SensorSize size : {SensorSize{10, 8},
                                  {9, 8},
                                  {12, 8},
                                  {11, 8},
                                  {12, 7},
                                  {18, 16},
                                  {20, 17},
                                  {58, 41},
                                  {61, 40}}) {
      const int row = size.width * channels(format);
      std::vector<std::uint8_t> bytes(static_cast<std::size_t>(row * size.height));
      for (int y = 0; y < size.height; ++y) {
        for (int i = 0; i < row; ++i) {
          const int range = 2 + i / 8 + y / 8;
          bytes[static_cast<std::size_t>(y * row + i)] =
              static_cast<std::uint8_t>(100 + static_cast<int>(random() % 1000) % range);
        }
      }
      for (const std::size_t cut_off : {0U, 1U, 2U, 3U}) {
        for (std::size_t i = 0; i < cut_off; ++i) {
          bytes[random() % bytes.size()] = i % 2 == 0 ? 255 : 0;
        }
        const ImageView frame{bytes.data(), size, static_cast<std::size_t>(row), format};
        const double expected = slowEstimate(frame);
        judged += expected > static_cast<double>(FrameNoiseEstimate::kLowest_dn) ? 1 : 0;
        ASSERT_NEAR(static_cast<double>(estimate.of(frame)), expected, 1e-5 * expected)
            << size.width << " x " << size.height << ", " << static_cast<int>(format);
      }
    }
  }
  EXPECT_GT(judged, 50);
}

TEST(FrameNoiseEstimate, TextureOnHalfOfTheFrameHardlyMatters) {
  Frame frame = noisyFrame(PixelFormat::kMono8, 1.5, 4);
  for (int y = 0; y < kSize.height / 2; ++y) {
    for (int x = 0; x < kSize.width; ++x) {
      frame.bytes[static_cast<std::size_t>(y) * frame.step + static_cast<std::size_t>(x)] =
          static_cast<std::uint8_t>(80 + 40 * ((x / 3 + y / 3) % 2));
    }
  }
  FrameNoiseEstimate estimate;
  EXPECT_NEAR(estimate.of(frame.view()), 1.5F, 0.25F);
}

TEST(FrameNoiseEstimate, StaysWithinItsBounds) {
  FrameNoiseEstimate estimate;
  EXPECT_EQ(estimate.of(noisyFrame(PixelFormat::kMono8, 0.0, 5).view()),
            FrameNoiseEstimate::kLowest_dn);
  EXPECT_EQ(estimate.of(noisyFrame(PixelFormat::kMono8, 15.0, 5).view()),
            FrameNoiseEstimate::kHighest_dn);
}

TEST(FrameNoiseEstimate, BlackSaturatedAndTinyFramesTellNothing) {
  FrameNoiseEstimate estimate;
  for (const std::uint8_t level : {0, 255}) {
    Frame frame(PixelFormat::kMono8);
    std::fill(frame.bytes.begin(), frame.bytes.end(), level);
    EXPECT_EQ(estimate.of(frame.view()), FrameNoiseEstimate::kLowest_dn);
  }
  const std::uint8_t pixel = 100;
  EXPECT_EQ(estimate.of({&pixel, {1, 1}, 1, PixelFormat::kMono8}), FrameNoiseEstimate::kLowest_dn);
}

}  // namespace
}  // namespace fast_edi
