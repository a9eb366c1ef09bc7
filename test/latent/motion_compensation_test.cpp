#include "fast_edi/latent/motion_compensation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "fast_edi/base/image_plane.hpp"

namespace fast_edi {
namespace {

constexpr SensorSize kSize{96, 72};
constexpr int kBorder_px = 8;
/// Between the reference and the other image [px].
constexpr double kShift_px = 1.3;

double waves(double x, double y) {
  return 120.0 + 40.0 * std::sin(0.31 * x + 0.17 * y) + 30.0 * std::sin(0.12 * x - 0.27 * y);
}

struct Image {
  PixelFormat format;
  std::vector<std::uint8_t> bytes;

  explicit Image(PixelFormat pixel_format)
      : format(pixel_format),
        bytes(kSize.pixelCount() * static_cast<std::size_t>(bytesPerPixel(pixel_format))) {}
  std::size_t step() const { return static_cast<std::size_t>(kSize.width * bytesPerPixel(format)); }
  ImageView view() const { return {bytes.data(), kSize, step(), format}; }
  MutableImageView mutableView() { return {bytes.data(), kSize, step(), format}; }
  std::vector<float> plane(int channel = 0) const {
    std::vector<float> levels(kSize.pixelCount());
    loadPlane(view(), channel, levels.data());
    return levels;
  }
};

std::size_t indexOf(int x, int y) {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(kSize.width) +
         static_cast<std::size_t>(x);
}

/// The waves, shifted and with noise.
std::vector<float> wavePlane(double shift_px, double noise_dn, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0.0, 1.0);
  std::vector<float> plane;
  for (int y = 0; y < kSize.height; ++y) {
    for (int x = 0; x < kSize.width; ++x) {
      plane.push_back(static_cast<float>(waves(x + shift_px, y) + noise_dn * noise(random)));
    }
  }
  return plane;
}

Image imageOf(const std::vector<float>& plane, PixelFormat format = PixelFormat::kMono8,
              float scale = 1.0F) {
  Image image(format);
  std::vector<float> levels(plane);
  for (float& level : levels) {
    level *= scale;
  }
  for (int channel = 0; channel < channels(format); ++channel) {
    storePlane(levels.data(), channel, image.mutableView());
  }
  return image;
}

/// Root mean square away from the border.
double error(const std::vector<float>& plane, const std::vector<float>& truth) {
  double squares = 0.0;
  int count = 0;
  for (int y = kBorder_px; y < kSize.height - kBorder_px; ++y) {
    for (int x = kBorder_px; x < kSize.width - kBorder_px; ++x) {
      squares += std::pow(static_cast<double>(plane[indexOf(x, y)] - truth[indexOf(x, y)]), 2);
      ++count;
    }
  }
  return std::sqrt(squares / count);
}

Image compensated(const Image& reference, Image image) {
  MotionCompensation compensation;
  compensation.setReference(reference.view());
  compensation.apply(image.mutableView());
  return image;
}

/// As the header says it, in double precision, of one channel. The flow is the one of OpticalFlow;
/// fractions of a pixel distance are rounded down to 1/256.
class Reference {
 public:
  Reference(const ImageView& reference, const ImageView& own)
      : size_(reference.size),
        stride_(isBayer(reference.format) ? 2 : 1),
        dn_(dnPerDn8(reference.format)) {
    std::vector<float> grey = levelsOf(reference, reference_);
    OpticalFlow flow(size_);
    flow.setTarget(grey.data());
    grey = levelsOf(own, own_);
    flow_ = flow.from(grey.data());
    for (int y = 0; y < size_.height; ++y) {
      for (int x = 0; x < size_.width; ++x) difference_.push_back(differenceAt(x, y));
    }
  }

  double level(int x, int y) const {
    double mean = 0.0;
    for (int v = y - 2; v <= y + 2; ++v) {
      for (int u = x - 2; u <= x + 2; ++u) {
        mean +=
            difference_[at(std::clamp(u, 0, size_.width - 1), std::clamp(v, 0, size_.height - 1))] /
            25.0;
      }
    }
    const double own = own_[at(x, y)];
    const double share = mean / (own + 10.0 * dn_) / 0.1;
    // In place of a Gaussian, as range_weight.hpp says it.
    const double weight = 0.9 * std::pow(std::max(0.0, 1.0 - share * share / 8.0), 4);
    return std::clamp(own + weight * difference_[at(x, y)], 0.0, 255.0 * dn_);
  }

 private:
  std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(size_.width) +
           static_cast<std::size_t>(x);
  }
  std::vector<float> levelsOf(const ImageView& image, std::vector<double>& levels) const {
    std::vector<float> plane(size_.pixelCount());
    loadPlane(image, 0, plane.data());
    levels.assign(plane.begin(), plane.end());
    for (float& level : plane) level /= static_cast<float>(dn_);
    return plane;
  }
  /// Catmull-Rom's spline through four values.
  static double spline(const std::array<double, 4>& p, double t) {
    return 0.5 *
           (2.0 * p[1] + (p[2] - p[0]) * t + (2.0 * p[0] - 5.0 * p[1] + 4.0 * p[2] - p[3]) * t * t +
            (3.0 * p[1] - p[0] - 3.0 * p[2] + p[3]) * t * t * t);
  }
  struct Place {
    std::array<int, 4> pixels;
    double fraction;
  };
  /// Four pixels of the colour of the one at \p own, about \p place.
  Place placeOf(double place, int own, int length) const {
    const int first = own % stride_;
    const int last = first + (length - 1 - first) / stride_ * stride_;
    const double steps = (place - first) / stride_;
    const int left = static_cast<int>(std::floor(steps));
    Place result{{}, std::floor((steps - left) * 256.0) / 256.0};
    for (int k = 0; k < 4; ++k) {
      result.pixels[static_cast<std::size_t>(k)] =
          std::clamp(first + (left - 1 + k) * stride_, first, last);
    }
    return result;
  }
  double differenceAt(int x, int y) const {
    const double from_x = static_cast<double>(static_cast<float>(x) + flow_[at(x, y)].x);
    const double from_y = static_cast<double>(static_cast<float>(y) + flow_[at(x, y)].y);
    if (from_x < 0.0 || from_x > size_.width - 1 || from_y < 0.0 || from_y > size_.height - 1)
      return 0.0;
    const Place across = placeOf(from_x, x, size_.width);
    const Place down = placeOf(from_y, y, size_.height);
    std::array<double, 4> rows{};
    for (std::size_t j = 0; j < 4; ++j) {
      std::array<double, 4> row{};
      for (std::size_t i = 0; i < 4; ++i) row[i] = reference_[at(across.pixels[i], down.pixels[j])];
      rows[j] = spline(row, across.fraction);
    }
    return spline(rows, down.fraction) - own_[at(x, y)];
  }

  SensorSize size_;
  int stride_;
  double dn_;
  std::vector<double> reference_;
  std::vector<double> own_;
  std::vector<Displacement> flow_;
  std::vector<double> difference_;
};

/// Where the flow leads out of the image, and splines reach beyond its border, too.
TEST(MotionCompensation, IsTheOneOfASlowReference) {
  for (const PixelFormat format :
       {PixelFormat::kMono16, PixelFormat::kMono8, PixelFormat::kBayer8}) {
    for (const double shift_px : {-2.4, 3.7}) {
      const auto dn = static_cast<float>(dnPerDn8(format));
      const Image reference = imageOf(wavePlane(0.0, 2.0, 5), format, dn);
      const Image own = imageOf(wavePlane(shift_px, 9.0, 6), format, dn);
      const Reference expected(reference.view(), own.view());
      const std::vector<float> found = compensated(reference, own).plane();
      int apart = 0;
      for (int y = 0; y < kSize.height; ++y) {
        for (int x = 0; x < kSize.width; ++x) {
          const double difference =
              static_cast<double>(found[indexOf(x, y)]) - expected.level(x, y);
          apart += std::abs(difference) > 0.55 ? 1 : 0;
        }
      }
      // What is rounded down in one precision may not be in another.
      EXPECT_LT(apart, 3) << static_cast<int>(format) << ", " << shift_px;
    }
  }
}

TEST(MotionCompensation, TakesOutNoiseThatTheReferenceDoesNotHave) {
  const std::vector<float> truth = wavePlane(kShift_px, 0.0, 0);
  const Image noisy = imageOf(wavePlane(kShift_px, 6.0, 1));
  const Image stabilised = compensated(imageOf(wavePlane(0.0, 0.0, 0)), noisy);
  EXPECT_GT(error(noisy.plane(), truth), 5.5);
  EXPECT_LT(error(stabilised.plane(), truth), 1.5);
}

TEST(MotionCompensation, LeavesAnImageThatEqualsTheReference) {
  const Image image = imageOf(wavePlane(0.0, 6.0, 2));
  EXPECT_EQ(compensated(image, image).bytes, image.bytes);
}

TEST(MotionCompensation, LeavesWhatDiffersByMoreThanNoise) {
  // A patch has become brighter, as when a lamp goes on: no motion explains it.
  std::vector<float> plane = wavePlane(0.0, 0.0, 0);
  for (int y = 30; y < 46; ++y) {
    for (int x = 40; x < 56; ++x) {
      plane[indexOf(x, y)] = 255.0F;
    }
  }
  const Image image = imageOf(plane);
  const Image stabilised = compensated(imageOf(wavePlane(0.0, 0.0, 0)), image);
  for (int y = 34; y < 42; ++y) {
    for (int x = 44; x < 52; ++x) {
      ASSERT_NEAR(stabilised.plane()[indexOf(x, y)], 255.0F, 1.0F);
    }
  }
}

TEST(MotionCompensation, WeighsByTheMeanDifferenceOfFiveByFivePixels) {
  constexpr float kLevel = 100.0F * 256.0F;  // [16-bit DN]
  constexpr float kLower = 94.0F * 256.0F;
  const int x = kSize.width / 2;
  const int y = kSize.height / 2;
  const Image reference =
      imageOf(std::vector<float>(kSize.pixelCount(), kLevel), PixelFormat::kMono16);
  // Of the pixel at (x, y), where all pixels that lie so far on each side are lower.
  const auto weighed = [&](int left, int right, int above, int below) {
    std::vector<float> plane(kSize.pixelCount(), kLevel);
    for (int v = y - above; v <= y + below; ++v) {
      for (int u = x - left; u <= x + right; ++u) {
        plane[indexOf(u, v)] = kLower;
      }
    }
    return compensated(reference, imageOf(plane, PixelFormat::kMono16)).plane()[indexOf(x, y)];
  };
  const float level = weighed(2, 2, 2, 2);
  EXPECT_GT(level, kLower + 256.0F);
  EXPECT_LT(level, kLevel - 256.0F);
  EXPECT_EQ(weighed(9, 9, 9, 9), level);
  for (const float less :
       {weighed(1, 2, 2, 2), weighed(2, 1, 2, 2), weighed(2, 2, 1, 2), weighed(2, 2, 2, 1)}) {
    EXPECT_GT(less, level);
  }
}

TEST(MotionCompensation, LeavesWhatComesFromOutside) {
  const double shift_px = 6.0;
  const Image noisy = imageOf(wavePlane(shift_px, 4.0, 3));
  const std::vector<float> before = noisy.plane();
  const std::vector<float> after = compensated(imageOf(wavePlane(0.0, 0.0, 0)), noisy).plane();
  for (int y = 0; y < kSize.height; ++y) {
    EXPECT_EQ(after[indexOf(kSize.width - 1, y)], before[indexOf(kSize.width - 1, y)]);
    EXPECT_EQ(after[indexOf(kSize.width - 3, y)], before[indexOf(kSize.width - 3, y)]);
  }
}

TEST(MotionCompensation, DoesTheSameInEachFormat) {
  const std::vector<float> truth = wavePlane(kShift_px, 0.0, 0);
  const std::vector<float> reference = wavePlane(0.0, 0.0, 0);
  const std::vector<float> noisy = wavePlane(kShift_px, 6.0, 4);
  const Image grey = compensated(imageOf(reference), imageOf(noisy));

  const auto dn16 = static_cast<float>(kDn16PerDn8);
  std::vector<float> wide = compensated(imageOf(reference, PixelFormat::kMono16, dn16),
                                        imageOf(noisy, PixelFormat::kMono16, dn16))
                                .plane();
  for (float& level : wide) {
    level /= dn16;
  }
  EXPECT_LT(error(wide, grey.plane()), 0.6);
  const Image colour =
      compensated(imageOf(reference, PixelFormat::kColour8), imageOf(noisy, PixelFormat::kColour8));
  for (int channel = 0; channel < 3; ++channel) {
    EXPECT_LT(error(colour.plane(channel), truth), 1.5);
  }
  // Photosites of one colour are two pixels apart: less is known between them.
  EXPECT_LT(error(compensated(imageOf(reference, PixelFormat::kBayer8),
                              imageOf(noisy, PixelFormat::kBayer8))
                      .plane(),
                  truth),
            2.0);
}

TEST(MotionCompensation, DoesNotMixTheColoursOfAMosaic) {
  // Red scene: photosites of the other colours stay dark, whatever the motion.
  const auto mosaic = [](double shift_px) {
    std::vector<float> plane = wavePlane(shift_px, 0.0, 0);
    for (int y = 0; y < kSize.height; ++y) {
      for (int x = 0; x < kSize.width; ++x) {
        if (x % 2 != 0 || y % 2 != 0) plane[indexOf(x, y)] = 5.0F;
      }
    }
    return imageOf(plane, PixelFormat::kBayer8);
  };
  const std::vector<float> after = compensated(mosaic(0.0), mosaic(kShift_px)).plane();
  for (int y = 0; y < kSize.height; ++y) {
    for (int x = 0; x < kSize.width; ++x) {
      if (x % 2 != 0 || y % 2 != 0) {
        ASSERT_EQ(after[indexOf(x, y)], 5.0F) << x << ", " << y;
      }
    }
  }
}

TEST(MotionCompensation, StaysWithinTheRangeOfLevels) {
  std::vector<float> checks(kSize.pixelCount());
  for (std::size_t i = 0; i < checks.size(); ++i) {
    checks[i] = (i / 3) % 2 == 0 ? 0.0F : 255.0F;
  }
  std::vector<float> moved(checks);
  std::rotate(moved.begin(), moved.begin() + 1, moved.end());
  const Image image = compensated(imageOf(checks), imageOf(moved));
  // Overshoot that wrapped around would turn white into black.
  EXPECT_LT(error(image.plane(), moved), 40.0);
}

TEST(MotionCompensation, TakesSmallImages) {
  for (const SensorSize size : {SensorSize{1, 1}, {2, 1}, {3, 5}}) {
    std::vector<std::uint8_t> reference(size.pixelCount(), 100);
    std::vector<std::uint8_t> image(size.pixelCount(), 104);
    MotionCompensation compensation;
    const auto step = static_cast<std::size_t>(size.width);
    compensation.setReference({reference.data(), size, step, PixelFormat::kBayer8});
    compensation.apply({image.data(), size, step, PixelFormat::kBayer8});
    for (const std::uint8_t level : image) {
      EXPECT_GE(level, 100);
      EXPECT_LE(level, 104);
    }
    EXPECT_GT(compensation.memoryBytes(), 0U);
  }
}

}  // namespace
}  // namespace fast_edi
