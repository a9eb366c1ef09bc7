#include "integral/running_integral.hpp"

#include <algorithm>

namespace fast_edi {
namespace {

/// Base instants are multiples of this. Larger: fewer predictions fail at a multiple; smaller:
/// fewer events to prepend when an interval is completed. About half a millisecond.
constexpr std::int64_t kBaseQuantum_ns = 1 << 19;

/// Running sums stay this far from the ends of the predicted interval: the prediction may be wrong
/// by that much without events having to be folded again.
constexpr std::int64_t kPredictionMargin_ns = 50 * kNanosecondsPerMicrosecond;

/// Floor to a multiple of a positive divisor.
std::int64_t floorMultiple(std::int64_t value, std::int64_t divisor) {
  const std::int64_t remainder = value % divisor;
  return value - (remainder < 0 ? remainder + divisor : remainder);
}

std::int64_t baseInstant(const ExposureInterval& interval) {
  const std::int64_t earliest_ns = interval.start_ns + kPredictionMargin_ns;
  const std::int64_t multiple_ns =
      floorMultiple(earliest_ns - 1, kBaseQuantum_ns) + kBaseQuantum_ns;
  return std::min(multiple_ns, interval.end_ns);
}

}  // namespace

void RunningIntegral::clear() {
  if (!clean_) {
    std::fill(sums_.begin(), sums_.end(), PixelSums{0.0, 1.0});
    clean_ = true;
  }
  started_ = false;
}

void RunningIntegral::reset() {
  clear();
  has_prediction_ = false;
}

void RunningIntegral::predictInterval(const ExposureInterval& interval) {
  clear();
  has_prediction_ = interval.length() > 0;
  predicted_ = interval;
}

void RunningIntegral::markSumsTaken() {
  clean_ = true;
  started_ = false;
}

void RunningIntegral::restartAt(const PixelEventLists& lists, std::int64_t base_ns) {
  clear();
  started_ = true;
  base_ns_ = base_ns;
  base_sequence_ = lists.lowerBound(base_ns);
  cursor_ = base_sequence_;
}

void RunningIntegral::accumulate(const PixelEventLists& lists, const EventFactors& factors,
                                 Weighting weighting) {
  if (!has_prediction_ || !lists.hasNewest()) {
    return;
  }
  if (!started_) {
    const std::int64_t base_ns = baseInstant(predicted_);
    if (lists.newest() < base_ns) {
      return;
    }
    restartAt(lists, base_ns);
  }
  if (cursor_ < lists.beginSequence()) {
    reset();  // overflow took events that were not folded in yet
    return;
  }
  fold(lists, lists.lowerBound(predicted_.end_ns - kPredictionMargin_ns), factors, weighting);
}

RunningIntegral::Result RunningIntegral::integrate(const PixelEventLists& lists,
                                                   const ExposureInterval& interval,
                                                   const EventFactors& factors,
                                                   Weighting weighting) {
  const std::int64_t base_ns = baseInstant(interval);
  const std::uint64_t begin = lists.lowerBound(interval.start_ns);
  const std::uint64_t base = lists.lowerBound(base_ns);
  const std::uint64_t end = lists.lowerBound(interval.end_ns);

  Result result;
  const bool sums_serve = started_ && base_ns_ == base_ns && base_sequence_ == base &&
                          base >= lists.beginSequence() && cursor_ <= end;
  if (!sums_serve) {
    restartAt(lists, base_ns);
  }
  result.predicted = sums_serve || interval.length() == 0;
  result.walked = (base - begin) + (end - cursor_);
  fold(lists, end, factors, weighting);
  prepend(lists, begin, factors, weighting);
  if (weighting == Weighting::kTime) {
    result.clock = {static_cast<double>(interval.start_ns - base_ns),
                    static_cast<double>(interval.end_ns - base_ns)};
  } else {
    result.clock = {-static_cast<double>(base - begin), static_cast<double>(end - base)};
  }
  has_prediction_ = false;
  return result;
}

/// Appends the events [cursor_, end) to the sums.
void RunningIntegral::fold(const PixelEventLists& lists, std::uint64_t end,
                           const EventFactors& factors, Weighting weighting) {
  while (cursor_ < end) {
    const PackedEventSpan span = lists.span(cursor_, end);
    if (factors.most_ticks > 0) {
      foldRampsByTime(span.data, span.intervals, span.count, span.base_ns - base_ns_, factors,
                      sums_.data());
    } else if (weighting == Weighting::kTime) {
      foldByTime(span.data, span.count, span.base_ns - base_ns_, factors, sums_.data());
    } else {
      foldByCounter(span.data, span.count, static_cast<std::int64_t>(cursor_ - base_sequence_),
                    factors, sums_.data());
    }
    clean_ = false;
    cursor_ += span.count;
  }
}

/// Puts the events [begin, base_sequence_) in front of the sums, newest first.
void RunningIntegral::prepend(const PixelEventLists& lists, std::uint64_t begin,
                              const EventFactors& factors, Weighting weighting) {
  std::uint64_t end = base_sequence_;
  while (end > begin) {
    // Spans run forward, so the one that ends at `end` is found from the beginning.
    std::uint64_t first = begin;
    PackedEventSpan span = lists.span(first, end);
    while (first + span.count < end) {
      first += span.count;
      span = lists.span(first, end);
    }
    const std::int64_t offset_ns = span.base_ns - base_ns_;
    for (std::size_t i = span.count; i-- > 0;) {
      const PackedEvent& event = span.data[i];
      const std::int64_t clock = weighting == Weighting::kTime
                                     ? static_cast<std::int64_t>(event.dt_ns) + offset_ns
                                     : static_cast<std::int64_t>(first + i - base_sequence_);
      const double multiplier = factors.multiplier[event.code & 1u];
      PixelSums& pixel = sums_[event.code >> 1];
      pixel.sum =
          multiplier * pixel.sum + factors.one_minus[event.code & 1u] * static_cast<double>(clock);
      if (factors.most_ticks > 0) {
        pixel.sum += factors.excess[event.code & 1u] *
                     static_cast<double>(std::min(span.intervals[i], factors.most_ticks));
      }
      pixel.value *= multiplier;
    }
    clean_ = false;
    end = first;
  }
}

}  // namespace fast_edi
