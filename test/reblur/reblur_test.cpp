#include "reblur/reblur.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "fast_edi/base/image.hpp"
#include "fast_edi/events/event_counts.hpp"
#include "reblur/log_levels.hpp"
#include "reblur/moving_plane.hpp"
#include "support/event_generators.hpp"

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

/// The last frame of a sequence, and what the filters know of it. Its latent image is the true one.
class KnownFrame {
 public:
  explicit KnownFrame(const SimulationSettings& settings)
      : model_{settings.sensor.thresholds, {4 * kNanosecondsPerMillisecond, 0.85}},
        mean_counts_(kPlaneSize.pixelCount()) {
    const SimulatedSequence sequence = simulateSequence(settings);
    const SimulatedFrame& frame = sequence.frames.back();
    window_ = frame.exposure;
    lists_.keepIntervals(true);
    lists_.append(testing::wireView(testing::toWire(sequence.events)));
    counts_.count(lists_, window_);
    quarters_.count(lists_, window_);
    for (std::size_t i = 0; i < kPlaneSize.pixelCount(); ++i) {
      mean_counts_[i] = static_cast<float>(counts_.off(i) + counts_.on(i));
      blurry_dn_.push_back(static_cast<float>(frame.blurry.data[i]));
      latent_dn_.push_back(static_cast<float>(frame.sharp.data[i]));
    }
  }

  Reblur::Frame frame() const {
    return {window_, blurry_dn_.data(), mean_counts_.data(), kNoise_dn, counts_.data(), &quarters_};
  }

  /// As the header says it: the steps one by one, and the image moved as far as it is trusted.
  struct Expected {
    std::vector<double> level_dn;
    FittedMotion motion;
    bool used = false;
  };
  Expected expected() const {
    std::vector<float> log(latent_dn_.size());
    logLevels(latent_dn_.data(), log.size(), kOffset_dn, log.data());
    EventChanges changes;
    changes.measure(lists_, window_, counts_.data(), quarters_, model_);
    const auto contrast = static_cast<float>((model_.thresholds.on + model_.thresholds.off) / 2.0);
    Expected result{{latent_dn_.begin(), latent_dn_.end()}, {}, false};
    result.motion = MotionFit(kPlaneSize).fit(log.data(), changes, mean_counts_.data(), contrast);
    const FittedMotion& m = result.motion;
    result.used = m.found && m.path_px >= 1.5F && m.reach_px <= 40.0F && m.deviation_px <= 0.4F &&
                  m.deviation_px <= 0.08F * m.path_px;
    if (!result.used) return result;
    MovingBlur blur;
    const SceneLayout layout(kPlaneSize, m.reach_px);
    blur.set(m.motion, layout,
             static_cast<std::size_t>(std::clamp(std::ceil(m.path_px / 2.5F), 4.0F, 7.0F)));
    ResidualSolver solver;
    solver.solve({blurry_dn_.data(), latent_dn_.data(), mean_counts_.data(), kNoise_dn, kOffset_dn},
                 blur);
    TrustMap trust;
    trust.measure({m.motion, changes, m.event_share, contrast, kNoise_dn, kOffset_dn}, layout,
                  solver);
    for (std::size_t i = 0; i < result.level_dn.size(); ++i) {
      const std::size_t at = layout.inScene(i % kPlaneSize.width, i / kPlaneSize.width);
      const auto solved = static_cast<double>(solver.solution()[at]);
      result.level_dn[i] += static_cast<double>(trust.trust()[i]) * (solved - result.level_dn[i]);
      result.level_dn[i] = std::clamp(result.level_dn[i], 0.0, 255.0);
    }
    return result;
  }

  /// Levels after Reblur, of an image of so many levels in an 8-bit DN.
  template <typename Level>
  std::vector<double> reblurred(PixelFormat format, bool clean) const {
    const double dn = dnPerDn8(format);
    std::vector<Level> image;
    std::vector<float> clean_levels;
    for (const float level : latent_dn_) {
      clean_levels.push_back(level * static_cast<float>(dn));
      image.push_back(static_cast<Level>(std::lround(static_cast<double>(level) * dn)));
    }
    Reblur reblur;
    Reblur::Frame input = frame();
    if (clean) input.clean_dn = clean_levels.data();
    reblur.apply(input, lists_, model_, CameraResponse::linear(static_cast<double>(kOffset_dn)),
                 {reinterpret_cast<std::uint8_t*>(image.data()), kPlaneSize,
                  sizeof(Level) * kPlaneSize.width, format});
    std::vector<double> levels;
    for (const Level level : image) levels.push_back(static_cast<double>(level) / dn);
    return levels;
  }

 private:
  static constexpr float kNoise_dn = 1.2F;
  static constexpr float kOffset_dn = 3.0F;

  LatentGains::Model model_;
  PixelEventLists lists_{kPlaneSize, {}};
  EventCounts counts_{kPlaneSize};
  LaterQuarters quarters_{kPlaneSize};
  ExposureInterval window_;
  std::vector<float> mean_counts_;
  std::vector<float> blurry_dn_;
  std::vector<float> latent_dn_;
};

/// Motions on both sides of what is known well enough, and paths of four to seven instants.
TEST(ReblurTest, IsItsStepsOneByOne) {
  int used = 0;
  int unused = 0;
  for (const auto& [kind, scale] : {std::pair{MotionKind::kShake, 0.15},
                                    {MotionKind::kShake, 0.4},
                                    {MotionKind::kShake, 1.0},
                                    {MotionKind::kShake, 1.3},
                                    {MotionKind::kShake, 1.6},
                                    {MotionKind::kMild, 2.2}}) {
    const KnownFrame frame(movingPlane(kind, scale));
    const KnownFrame::Expected expected = frame.expected();
    (expected.used ? used : unused) += 1;
    const std::vector<double> bytes = frame.reblurred<std::uint8_t>(PixelFormat::kMono8, false);
    const std::vector<double> wide = frame.reblurred<std::uint16_t>(PixelFormat::kMono16, true);
    for (std::size_t i = 0; i < bytes.size(); ++i) {
      ASSERT_NEAR(bytes[i], expected.level_dn[i], 0.501) << scale << ", " << i;
      ASSERT_NEAR(wide[i], expected.level_dn[i], 0.01) << scale << ", " << i;
    }
  }
  EXPECT_EQ(used, 3);
  EXPECT_EQ(unused, 3);
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
