#include "sequences/sequence_tables.hpp"

namespace fast_edi {
namespace {

using Extra = SequenceExtra;
using Motion = MotionKind;
using Texture = TextureKind;

SequenceRow row(const char* name, const char* sensor, Texture texture, Motion motion, double scale,
                std::int64_t exposure_ms, ContrastThresholds thresholds) {
  SequenceRow made;
  made.name = name;
  made.sensor = sensor;
  made.texture = texture;
  made.motion = motion;
  made.motion_scale = scale;
  made.exposure_ms = exposure_ms;
  made.thresholds = thresholds;
  return made;
}

SequenceRow row(const char* name, const char* sensor, const char* photograph, Motion motion,
                double scale, std::int64_t exposure_ms, ContrastThresholds thresholds) {
  SequenceRow made = row(name, sensor, Texture::kFlat, motion, scale, exposure_ms, thresholds);
  made.photograph = photograph;
  return made;
}

}  // namespace

// name, sensor, texture or photograph, motion, its scale, exposure [ms], thresholds {ON, OFF}

std::vector<SequenceRow> choosingRows() {
  return {
      row("clean-poster-shake", "clean", Texture::kPoster, Motion::kShake, 1.0, 30, {0.25, 0.25}),
      row("clean-clouds-mild", "clean", Texture::kClouds, Motion::kMild, 1.0, 25, {0.20, 0.20}),
      row("slow-natural-shake", "slow", Texture::kNatural, Motion::kShake, 0.6, 30, {0.25, 0.25}),
      row("slow-poster-mild", "slow", Texture::kPoster, Motion::kMild, 1.0, 30, {0.25, 0.30})
          .on346()
          .lit(0.6),
      row("slow-clouds-pan-wrong", "slow", Texture::kClouds, Motion::kPan, 0.5, 25, {0.30, 0.30})
          .given(0.8)
          .noisy(2.0),
      row("noisy-natural-spin", "slow-noisy", Texture::kNatural, Motion::kSpin, 0.5, 30,
          {0.25, 0.25})
          .lit(0.8),
      row("noisy-poster-mild-dim", "slow-noisy", Texture::kPoster, Motion::kMild, 1.0, 40,
          {0.30, 0.35})
          .lit(0.25)
          .noisy(1.5),
      row("mismatch-poster-shake", "mismatch", Texture::kPoster, Motion::kShake, 0.7, 20,
          {0.30, 0.25}),
      row("mismatch-natural-mild-wrong", "mismatch", Texture::kNatural, Motion::kMild, 1.5, 40,
          {0.20, 0.25})
          .given(1.15),
      row("davis346-poster-shake", "davis346", Texture::kPoster, Motion::kShake, 0.8, 20,
          {0.26, 0.24})
          .on346(),
      row("davis346-clouds-shake-dim", "davis346", Texture::kClouds, Motion::kShake, 0.5, 40,
          {0.26, 0.24})
          .lit(0.25)
          .given(1.2)
          .noisy(1.4),
      row("davis346-natural-saturated", "davis346", Texture::kNatural, Motion::kShake, 0.7, 15,
          {0.40, 0.45})
          .lit(1.8),
      row("davis240-poster-pan", "davis240", Texture::kPoster, Motion::kPan, 0.8, 20, {0.23, 0.24}),
      row("davis240-natural-mild-dim", "davis240", Texture::kNatural, Motion::kMild, 1.0, 60,
          {0.20, 0.22})
          .contrasted(0.5)
          .lit(0.2),
      row("davis240-clouds-faint-wrong", "davis240", Texture::kClouds, Motion::kShake, 0.5, 10,
          {0.15, 0.18})
          .contrasted(0.4)
          .given(0.85),
      row("refractory-poster-spin", "refractory", Texture::kPoster, Motion::kSpin, 1.0, 20,
          {0.25, 0.25}),
      row("delay1-natural-shake", "typical", Texture::kNatural, Motion::kShake, 0.6, 30,
          {0.25, 0.25})
          .late(1'000),
      row("delay3-poster-mild", "clean", Texture::kPoster, Motion::kMild, 1.5, 30, {0.25, 0.20})
          .late(3'000),
      row("delay5-clouds-pan", "typical", Texture::kClouds, Motion::kPan, 0.6, 20, {0.30, 0.30})
          .lit(0.8)
          .late(5'000),
      row("hot-pairs-poster-mild", "davis346", Texture::kPoster, Motion::kMild, 1.2, 30,
          {0.26, 0.24})
          .with(Extra::kHotPairs),
      row("hot-column-natural-shake", "davis346", Texture::kNatural, Motion::kShake, 0.5, 25,
          {0.26, 0.24})
          .with(Extra::kHotColumn),
      row("flicker-poster-mild", "davis346", Texture::kPoster, Motion::kMild, 1.0, 20, {0.26, 0.24})
          .lit(0.8)
          .with(Extra::kLamps),
      row("typical-flat-shake", "typical", Texture::kFlat, Motion::kShake, 0.8, 20, {0.20, 0.20}),
      row("short-poster-shake", "davis346", Texture::kPoster, Motion::kShake, 1.0, 5, {0.35, 0.40})
          .contrasted(0.5),
      row("photo-garden-slow", "slow", "mate/nature/Garden.jpg", Motion::kPan, 0.4, 30,
          {0.25, 0.25})
          .on346(),
      row("photo-wood-davis240", "davis240", "mate/nature/Wood.jpg", Motion::kShake, 0.5, 20,
          {0.25, 0.25}),
      row("photo-rain-clean", "clean", "mate/nature/RainDrops.jpg", Motion::kShake, 0.8, 30,
          {0.20, 0.20}),
      row("photo-storm-dim", "davis346", "mate/nature/Storm.jpg", Motion::kMild, 1.0, 40,
          {0.26, 0.24})
          .lit(0.3)
          .given(1.1),
  };
}

std::vector<SequenceRow> judgingRows() {
  return {
      row("clean-facade-shake", "clean", Texture::kFacade, Motion::kShake, 1.0, 25, {0.25, 0.25}),
      row("clean-weave-mild", "clean", Texture::kWeave, Motion::kMild, 1.0, 30, {0.30, 0.25}),
      row("clean-page-spin", "clean", Texture::kPage, Motion::kSpin, 0.6, 30, {0.20, 0.25}).on346(),
      row("slow-mosaic-shake", "slow", Texture::kMosaic, Motion::kShake, 0.7, 25, {0.25, 0.25}),
      row("slow-page-mild", "slow", Texture::kPage, Motion::kMild, 1.2, 30, {0.25, 0.25})
          .on346()
          .lit(0.7),
      row("slow-facade-pan-wrong", "slow", Texture::kFacade, Motion::kPan, 0.5, 30, {0.30, 0.35})
          .given(1.2)
          .noisy(1.5),
      row("noisy-weave-spin", "slow-noisy", Texture::kWeave, Motion::kSpin, 0.4, 30, {0.25, 0.25}),
      row("noisy-mosaic-mild-dim", "slow-noisy", Texture::kMosaic, Motion::kMild, 1.2, 40,
          {0.30, 0.30})
          .lit(0.25),
      row("mismatch-page-shake", "mismatch", Texture::kPage, Motion::kShake, 0.6, 20, {0.25, 0.30}),
      row("mismatch-facade-mild-wrong", "mismatch", Texture::kFacade, Motion::kMild, 1.5, 40,
          {0.25, 0.20})
          .given(0.8),
      row("davis346-mosaic-shake", "davis346", Texture::kMosaic, Motion::kShake, 0.8, 20,
          {0.26, 0.24})
          .on346(),
      row("davis346-weave-shake-dim", "davis346", Texture::kWeave, Motion::kShake, 0.4, 40,
          {0.26, 0.24})
          .lit(0.25)
          .noisy(1.4),
      row("davis346-facade-saturated", "davis346", Texture::kFacade, Motion::kShake, 0.7, 15,
          {0.45, 0.40})
          .lit(1.9),
      row("davis346-mosaic-wrong", "davis346", Texture::kMosaic, Motion::kShake, 0.6, 30,
          {0.26, 0.24})
          .given(1.2),
      row("davis240-page-pan", "davis240", Texture::kPage, Motion::kPan, 0.7, 20, {0.23, 0.24}),
      row("davis240-facade-mild-dim", "davis240", Texture::kFacade, Motion::kMild, 1.0, 60,
          {0.22, 0.20})
          .contrasted(0.5)
          .lit(0.2),
      row("davis240-weave-faint-wrong", "davis240", Texture::kWeave, Motion::kShake, 0.5, 15,
          {0.18, 0.15})
          .contrasted(0.4)
          .given(0.85),
      row("refractory-mosaic-spin", "refractory", Texture::kMosaic, Motion::kSpin, 1.0, 20,
          {0.25, 0.25}),
      row("refractory-weave-shake", "refractory", Texture::kWeave, Motion::kShake, 0.6, 20,
          {0.30, 0.30}),
      row("delay1-facade-pan", "typical", Texture::kFacade, Motion::kPan, 0.7, 25, {0.25, 0.25})
          .late(1'000),
      row("delay2-weave-mild", "clean", Texture::kWeave, Motion::kMild, 1.5, 30, {0.20, 0.25})
          .late(2'000),
      row("delay4-mosaic-shake", "typical", Texture::kMosaic, Motion::kShake, 0.6, 30, {0.30, 0.25})
          .lit(0.9)
          .late(4'000),
      row("delay5-page-mild", "typical", Texture::kPage, Motion::kMild, 1.5, 30, {0.25, 0.25})
          .late(5'000),
      row("hot-blocks-page-mild", "davis346", Texture::kPage, Motion::kMild, 1.2, 30, {0.26, 0.24})
          .with(Extra::kHotBlocks),
      row("hot-rows-mosaic-shake", "davis346", Texture::kMosaic, Motion::kShake, 0.5, 25,
          {0.26, 0.24})
          .with(Extra::kHotRows),
      row("hot-pairs-facade-shake", "davis346", Texture::kFacade, Motion::kShake, 0.5, 25,
          {0.26, 0.24})
          .with(Extra::kHotPairs),
      row("flicker-facade-mild", "davis346", Texture::kFacade, Motion::kMild, 1.0, 20, {0.26, 0.24})
          .lit(0.8)
          .with(Extra::kLamps),
      row("short-mosaic-shake", "davis346", Texture::kMosaic, Motion::kShake, 1.0, 5, {0.40, 0.35})
          .contrasted(0.5),
      row("photo-dune-slow", "slow", "mate/nature/Dune.jpg", Motion::kShake, 0.5, 30, {0.25, 0.25})
          .on346(),
      row("photo-meadow-slow", "slow", "mate/nature/GreenMeadow.jpg", Motion::kPan, 0.5, 30,
          {0.25, 0.25}),
      row("photo-wings-noisy", "slow-noisy", "mate/nature/TwoWings.jpg", Motion::kMild, 1.2, 30,
          {0.25, 0.25})
          .lit(0.8),
      row("photo-flower-davis240", "davis240", "mate/nature/FreshFlower.jpg", Motion::kShake, 0.5,
          20, {0.25, 0.25}),
      row("photo-blinds-davis346", "davis346", "mate/nature/Blinds.jpg", Motion::kShake, 0.8, 25,
          {0.26, 0.24}),
      row("photo-ladybird-clean", "clean", "mate/nature/LadyBird.jpg", Motion::kShake, 0.7, 30,
          {0.20, 0.20}),
      row("photo-aqua-wrong", "davis346", "mate/nature/Aqua.jpg", Motion::kMild, 1.2, 30,
          {0.26, 0.24})
          .lit(0.8)
          .given(0.85),
      row("photo-yellow-delay3", "typical", "mate/nature/YellowFlower.jpg", Motion::kShake, 0.5, 25,
          {0.25, 0.25})
          .late(3'000),
  };
}

}  // namespace fast_edi
