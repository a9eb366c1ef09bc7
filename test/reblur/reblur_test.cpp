#include "reblur/reblur.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "reblur/moving_plane.hpp"

namespace fast_edi {
namespace {

using testing::kPlaneSize;
using testing::lastImage;
using testing::movingPlane;
using testing::psnrOf;

struct Gain {
  explicit Gain(const SimulationSettings& settings) : Gain(simulateSequence(settings), settings) {}
  Gain(const SimulatedSequence& sequence, const SimulationSettings& settings, double factor = 1.0)
      : without(lastImage(sequence, settings, false, factor)),
        with(lastImage(sequence, settings, true, factor)),
        db(psnrOf(with, sequence.frames.back().sharp) -
           psnrOf(without, sequence.frames.back().sharp)) {}

  std::vector<std::uint8_t> without;
  std::vector<std::uint8_t> with;
  double db;
};

TEST(ReblurTest, GainsOnAShakenPlaneEvenWithThresholdsThatAreWrongByAFifth) {
  const SimulationSettings settings = movingPlane(MotionKind::kShake, 1.0);
  const SimulatedSequence sequence = simulateSequence(settings);
  EXPECT_GT(Gain(sequence, settings).db, 0.5);
  for (const double factor : {0.8, 1.2}) {
    EXPECT_GT(Gain(sequence, settings, factor).db, 0.0) << factor;
  }
}

TEST(ReblurTest, StillAndNearlyStillFramesKeepTheirBits) {
  const Gain still(movingPlane(MotionKind::kStill, 1.0));
  EXPECT_EQ(still.with, still.without);
  const Gain nearly_still(movingPlane(MotionKind::kMild, 0.1));
  EXPECT_EQ(nearly_still.with, nearly_still.without);
}

TEST(ReblurTest, AStillBackgroundBehindAMovingDiscIsNotSharpened) {
  const SimulationSettings settings = movingPlane(MotionKind::kStill, 1.0);
  const Gain gain(testing::DiscBeforeWall(settings).simulate(), settings);
  EXPECT_GT(gain.db, -0.1);
  constexpr int kBehind_px = 100;  // the disc has not come there yet
  int changed = 0;
  for (int y = 0; y < kPlaneSize.height; ++y) {
    for (int x = kBehind_px + 25; x < kPlaneSize.width; ++x) {
      const auto i = static_cast<std::size_t>(y) * kPlaneSize.width + static_cast<std::size_t>(x);
      changed += std::abs(gain.with[i] - gain.without[i]) > 2 ? 1 : 0;
    }
  }
  EXPECT_LT(changed, 20);
}

/// What is trusted has the noise that the solution leaves, not what was to stay besides.
TEST(ReblurTest, NoiseStaysOnlyWhereTheSolutionIsNotTrusted) {
  const SimulationSettings settings = movingPlane(MotionKind::kShake, 1.0);
  const SimulatedSequence sequence = simulateSequence(settings);
  const auto deblurred = [&](bool reblur, double noise_kept) {
    DeblurParameters parameters;
    parameters.filter.reblur = reblur;
    parameters.filter.frame_noise_kept = noise_kept;
    return testing::deblur(sequence, settings, parameters);
  };
  const testing::RecordingSink clean = deblurred(true, 0.0);
  const testing::RecordingSink noisy = deblurred(true, 1.0);
  const std::vector<float>& trust = clean.trust_maps.back();
  EXPECT_EQ(noisy.trust_maps.back(), trust);
  EXPECT_GT(std::count(trust.begin(), trust.end(), 1.0F), 1000);
  for (std::size_t i = 0; i < trust.size(); ++i) {
    if (trust[i] == 1.0F) {
      EXPECT_EQ(noisy.outputs.back().pixels[i], clean.outputs.back().pixels[i]) << i;
    }
  }
  EXPECT_NE(deblurred(false, 1.0).outputs.back().pixels,
            deblurred(false, 0.0).outputs.back().pixels);
}

TEST(ReblurTest, SupportsMonochromeImagesOfALinearResponse) {
  EXPECT_TRUE(Reblur::supports(PixelFormat::kMono8, CameraResponse::linear()));
  EXPECT_TRUE(Reblur::supports(PixelFormat::kMono16, CameraResponse::linear(3.0)));
  EXPECT_FALSE(Reblur::supports(PixelFormat::kBayer8, CameraResponse::linear()));
  EXPECT_FALSE(Reblur::supports(PixelFormat::kColour8, CameraResponse::linear()));
  std::vector<double> table(256);
  for (std::size_t i = 0; i < table.size(); ++i) table[i] = 0.02 * static_cast<double>(i);
  EXPECT_FALSE(Reblur::supports(PixelFormat::kMono8, CameraResponse::fromTable(table)));
}

TEST(ReblurTest, SmallImagesAreLeftAsTheyAre) {
  for (const SensorSize size : {SensorSize{1, 1}, SensorSize{31, 200}, SensorSize{200, 31}}) {
    std::vector<std::uint8_t> pixels(size.pixelCount(), 77);
    PixelEventLists lists(size, {});
    Reblur reblur;
    reblur.apply({{0, 1000}, nullptr, nullptr, 1.0F}, lists, {{0.2, 0.2}, {}},
                 CameraResponse::linear(),
                 {pixels.data(), size, static_cast<std::size_t>(size.width), PixelFormat::kMono8});
    EXPECT_EQ(pixels, std::vector<std::uint8_t>(size.pixelCount(), 77));
    EXPECT_EQ(reblur.trust(), std::vector<float>(size.pixelCount(), 0.0F));
  }
}

}  // namespace
}  // namespace fast_edi
