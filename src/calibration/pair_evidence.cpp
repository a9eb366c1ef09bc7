#include "calibration/pair_evidence.hpp"

#include <algorithm>
#include <array>

namespace fast_edi {
namespace {

/// Of wanted events in the order of time, so that the next ones' pixels come into the cache in
/// time.
constexpr std::size_t kFetchDistance = 16;
/// Events that are looked through for those of wanted rows before these are summed up.
constexpr std::size_t kScannedEvents = 2048;

/// y of a pixel y * width + x without a division: exact while pixels * width < 2^32, which holds
/// for all sizes that PixelEventLists takes.
class RowOfPixel {
 public:
  explicit RowOfPixel(int width)
      : factor_((std::uint64_t{1} << kShift) / static_cast<std::uint64_t>(width) + 1) {}
  std::size_t operator()(std::uint32_t pixel) const {
    return static_cast<std::size_t>((pixel * factor_) >> kShift);
  }

 private:
  static constexpr int kShift = 46;
  std::uint64_t factor_;
};

/// Lets the pixel of an event that is soon to be summed up come into the cache.
void fetch(const PackedEventSpan& events, std::size_t i, PairEvidence::Pixel* pixels) {
  __builtin_prefetch(pixels + (events.data[i].code >> 1), 1);
}

}  // namespace

/// Adds the events of one pair to the pixels.
class PairEvidence::Summation {
 public:
  Summation(const ExposurePair& pair, const ContrastThresholds& thresholds, const LevelModel& level)
      : pair_(pair),
        level_(level),
        has_ramps_(!level.isStaircase()),
        rate_{1.0F / static_cast<float>(pair.first.length()), 0.0F,
              -1.0F / static_cast<float>(pair.second.length())},
        origin_ns_{pair.first.start_ns, 0, pair.second.end_ns},
        step_{static_cast<float>(thresholds.step(false)),
              static_cast<float>(thresholds.step(true))},
        first_reference_{pair.first_reference_ns, pair.first.end_ns},
        second_reference_{pair.second_reference_ns, pair.second.end_ns},
        mean_lead_(static_cast<float>(kHalf * level.fraction)) {
    constexpr auto kNsPerMs = static_cast<float>(kNanosecondsPerMillisecond);
    for (std::size_t phase = 0; phase < kPhases; ++phase) {
      for (std::size_t on = 0; on < 2; ++on) {
        slope_[phase][on] = -step_[on] * rate_[phase] * kNsPerMs;
      }
    }
  }

  void add(const PackedEventSpan& span, std::size_t i, Pixel* pixels) const {
    constexpr float kConstant[kPhases] = {0.0F, 1.0F, 0.0F};
    const PackedEvent& event = span.data[i];
    const std::int64_t t_ns = span.base_ns + static_cast<std::int64_t>(event.dt_ns);
    const std::uint16_t ticks = has_ramps_ ? span.intervals[i] : std::uint16_t{0};
    const std::uint32_t on = event.code & 1u;
    const std::int64_t mean_ns =
        t_ns - static_cast<std::int64_t>(mean_lead_ * static_cast<float>(level_.rampBefore(ticks)));
    const std::size_t phase = phaseOf(mean_ns);
    const float weight = std::max(
        0.0F, static_cast<float>(mean_ns - origin_ns_[phase]) * rate_[phase] + kConstant[phase]);
    Pixel& pixel = pixels[event.code >> 1];
    pixel.weight[on] += weight;
    pixel.slope += slope_[phase][on];
    pixel.count += 1.0F;
    if (t_ns >= pair_.first_reference_ns) {
      pixel.level += step_[on] * static_cast<float>(level_.reached(t_ns, ticks, second_reference_) -
                                                    level_.reached(t_ns, ticks, first_reference_));
    }
  }

 private:
  static constexpr std::size_t kPhases = 3;
  static constexpr double kHalf = 0.5;  // of a ramp: where its mean is

  /// 0 within the first exposure, 1 between both, 2 within the second.
  std::size_t phaseOf(std::int64_t t_ns) const {
    return t_ns < pair_.first.end_ns ? 0 : t_ns < pair_.second.start_ns ? 1 : 2;
  }

  ExposurePair pair_;
  LevelModel level_;
  bool has_ramps_;
  float rate_[kPhases];  ///< of the weight over time, by phase [1/ns]
  std::int64_t origin_ns_[kPhases];
  float step_[2];              ///< by polarity [natural log]
  float slope_[kPhases][2]{};  ///< by phase and polarity [1/ms]
  LevelInstant first_reference_;
  LevelInstant second_reference_;
  float mean_lead_;
};

PairEvidence::PairEvidence(SensorSize size)
    : size_(size), is_wanted_(static_cast<std::size_t>(size.height)), pixels_(size.pixelCount()) {}

void PairEvidence::clear(const RowSample& rows) {
  std::fill(is_wanted_.begin(), is_wanted_.end(), std::uint8_t{0});
  const auto width = static_cast<std::size_t>(size_.width);
  for (int y = rows.first; y < size_.height; y += rows.step) {
    is_wanted_[static_cast<std::size_t>(y)] = 1;
    std::fill_n(pixels_.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(y) * width),
                width, Pixel{});
  }
}

void PairEvidence::gather(const PixelEventLists& lists, const ExposurePair& pair,
                          const ContrastThresholds& thresholds, const LevelModel& level,
                          const RowSample& rows) {
  clear(rows);
  const Summation summation(pair, thresholds, level);
  const std::uint64_t end = lists.lowerBound(pair.second.end_ns);
  for (std::uint64_t sequence = lists.lowerBound(pair.first.start_ns); sequence < end;) {
    const PackedEventSpan span = lists.span(sequence, end);
    if (rows.step == 1) {
      addAll(span, summation);
    } else {
      addWanted(span, summation);
    }
    sequence += span.count;
  }
}

// Both copy what they read, so that the sums written cannot be taken for a change of it.

void PairEvidence::addAll(const PackedEventSpan& span, const Summation& summation) {
  const Summation local = summation;
  Pixel* const pixels = pixels_.data();
  const PackedEventSpan events = span;
  for (std::size_t i = 0; i < events.count; ++i) {
    fetch(events, std::min(i + kFetchDistance, events.count - 1), pixels);
    local.add(events, i, pixels);
  }
}

void PairEvidence::addWanted(const PackedEventSpan& span, const Summation& summation) {
  const Summation local = summation;
  Pixel* const pixels = pixels_.data();
  const PackedEventSpan events = span;
  const RowOfPixel row_of(size_.width);
  std::array<std::uint32_t, kScannedEvents + 1>
      wanted{};  // one more: each is written, not each counts
  for (std::size_t from = 0; from < events.count; from += kScannedEvents) {
    const std::size_t to = std::min(from + kScannedEvents, events.count);
    std::size_t count = 0;
    for (std::size_t i = from; i < to; ++i) {
      wanted[count] = static_cast<std::uint32_t>(i);
      count += is_wanted_[row_of(events.data[i].code >> 1)];
    }
    for (std::size_t k = 0; k < count; ++k) {
      fetch(events, wanted[std::min(k + kFetchDistance, count - 1)], pixels);
      local.add(events, wanted[k], pixels);
    }
  }
}

}  // namespace fast_edi
