/// \file
/// What the events of a pair of frames say about each pixel: the sums that OnlineCalibration fits
/// to (equations in online_calibration.hpp).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "fast_edi/base/contrast_threshold.hpp"
#include "fast_edi/base/level_model.hpp"
#include "fast_edi/base/types.hpp"
#include "fast_edi/events/pixel_event_lists.hpp"

namespace fast_edi {

/// Two exposures, the first one over before the second one begins, and what their images refer to.
struct ExposurePair {
  ExposureInterval first;
  ExposureInterval second;
  std::int64_t first_reference_ns = 0;
  std::int64_t second_reference_ns = 0;
};

/// Rows first, first + step, first + 2 step, ...
struct RowSample {
  int first = 0;
  int step = 1;
};

class PairEvidence {
 public:
  struct Pixel {
    float weight[2];  ///< x_off, x_on
    float slope;      ///< x_t [1/ms]
    float level;      ///< l
    float count;      ///< events
  };

  explicit PairEvidence(SensorSize size);

  /// Sums up the events of both exposures and of the time between them, on some rows. Events of
  /// other rows cost a small part of what those cost.
  /// \pre \p lists hold all events from the start of the first exposure to the end of the second
  void gather(const PixelEventLists& lists, const ExposurePair& pair,
              const ContrastThresholds& thresholds, const LevelModel& level, const RowSample& rows);

  /// Pixels of a row that was gathered.
  const Pixel* row(int y) const {
    return pixels_.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(size_.width);
  }
  std::size_t memoryBytes() const { return pixels_.capacity() * sizeof(Pixel); }

 private:
  class Summation;

  void clear(const RowSample& rows);
  void addAll(const PackedEventSpan& span, const Summation& summation);
  void addWanted(const PackedEventSpan& span, const Summation& summation);

  SensorSize size_;
  std::vector<std::uint8_t> is_wanted_;  ///< by row: 1 for those of the sample
  std::vector<Pixel> pixels_;
};

}  // namespace fast_edi
