/// \file
/// What the sequences to choose by and to judge by are, one row each.
#pragma once

#include <cstdint>
#include <vector>

#include "scenes/simulation_settings.hpp"

namespace fast_edi {

enum class SequenceExtra { kNone, kHotPairs, kHotBlocks, kHotRows, kHotColumn, kLamps };

struct SequenceRow {
  const char* name = "";
  const char* sensor = "typical";  ///< a sensor model
  SensorSize size = kDavis240cSize;
  TextureKind texture = TextureKind::kPoster;
  const char* photograph = nullptr;  ///< instead of the texture: a path below their folder
  double contrast = 1.0;             ///< of the texture
  MotionKind motion = MotionKind::kShake;
  double motion_scale = 1.0;
  double light = 1.0;
  std::int64_t exposure_ms = 0;
  ContrastThresholds thresholds{};  ///< true ones
  double threshold_factor = 1.0;    ///< given thresholds over true ones
  double frame_noise = 1.0;         ///< factor on the model's read noise
  std::int64_t delay_us = 0;
  SequenceExtra extra = SequenceExtra::kNone;

  SequenceRow on346() const { return changed(&SequenceRow::size, kDavis346Size); }
  SequenceRow contrasted(double by) const { return changed(&SequenceRow::contrast, by); }
  SequenceRow lit(double by) const { return changed(&SequenceRow::light, by); }
  SequenceRow given(double factor) const { return changed(&SequenceRow::threshold_factor, factor); }
  SequenceRow noisy(double factor) const { return changed(&SequenceRow::frame_noise, factor); }
  SequenceRow late(std::int64_t us) const { return changed(&SequenceRow::delay_us, us); }
  SequenceRow with(SequenceExtra what) const { return changed(&SequenceRow::extra, what); }

 private:
  template <typename Value>
  SequenceRow changed(Value SequenceRow::*member, Value value) const {
    SequenceRow other = *this;
    other.*member = value;
    return other;
  }
};

/// Row i of a set has its first seed plus i. No seed of one set may occur in the other.
constexpr std::uint64_t kFirstChoosingSeed = 1001;
constexpr std::uint64_t kFirstJudgingSeed = 9001;

/// Poster, natural, clouds, flat and four photographs.
std::vector<SequenceRow> choosingRows();
/// Mosaic, page, facade, weave and eight photographs: never to choose by.
std::vector<SequenceRow> judgingRows();

}  // namespace fast_edi
