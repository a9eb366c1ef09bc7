#include "fast_edi/core/double_integral.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "fold_kernel.hpp"
#include "gain_kernel.hpp"

namespace fast_edi {
namespace {

/// Base instants are multiples of this, so that windows a few microseconds apart share one. Larger:
/// fewer predictions fail at a multiple; smaller: fewer events to prepend at close. About 1 ms.
constexpr std::int64_t kBaseQuantum_ns = 1 << 20;

/// Running sums stay this far from the ends of the expected window and from its reference time:
/// what a prediction may be off without the events having to be walked again.
constexpr std::int64_t kPredictionMargin_ns = 50 * kNanosecondsPerMicrosecond;

void requirePositive(const char* name, double threshold) {
  if (!std::isfinite(threshold) || threshold <= 0.0) {
    throw std::invalid_argument(std::string(name) + " is " + std::to_string(threshold) +
                                ", expected a finite number > 0");
  }
}

/// Floor division for a positive divisor.
std::int64_t floorMultiple(std::int64_t value, std::int64_t divisor) {
  const std::int64_t remainder = value % divisor;
  return value - (remainder < 0 ? remainder + divisor : remainder);
}

/// Calls visit(span) for the spans that make up the events [begin, end), in time order.
template <typename Visit>
void forEachSpan(const PixelEventLists& lists, std::uint64_t begin, std::uint64_t end,
                 Visit visit) {
  for (std::uint64_t sequence = begin; sequence < end;) {
    const PackedEventSpan span = lists.span(sequence, end);
    visit(span);
    sequence += span.count;
  }
}

}  // namespace

DoubleIntegral::DoubleIntegral(SensorSize size, ContrastThresholds thresholds, Weighting weighting)
    : size_(size),
      weighting_(weighting),
      factors_(std::make_unique<EventFactors>()),
      sums_(size.pixelCount()),
      reference_value_(size.pixelCount(), 1.0) {
  setThresholds(thresholds);
}

DoubleIntegral::~DoubleIntegral() = default;

void DoubleIntegral::setThresholds(ContrastThresholds thresholds) {
  requirePositive("ON contrast threshold", thresholds.on);
  requirePositive("OFF contrast threshold", thresholds.off);
  thresholds_ = thresholds;
  for (const bool on : {false, true}) {
    factors_->multiplier[on] = std::exp(thresholds.step(on));
    factors_->one_minus[on] = -std::expm1(thresholds.step(on));
  }
  clear();
}

std::size_t DoubleIntegral::memoryBytes() const {
  return sums_.capacity() * sizeof(PixelSums) + reference_value_.capacity() * sizeof(double);
}

/// The first multiple of kBaseQuantum_ns that lies a margin after the window's start, or the
/// window's end if that comes first.
std::int64_t DoubleIntegral::baseInstant(const ExposureInterval& window) {
  const std::int64_t earliest_ns = window.start_ns + kPredictionMargin_ns;
  const std::int64_t multiple_ns =
      floorMultiple(earliest_ns - 1, kBaseQuantum_ns) + kBaseQuantum_ns;
  return std::min(multiple_ns, window.end_ns);
}

void DoubleIntegral::clear() {
  if (!clean_) {
    std::fill(sums_.begin(), sums_.end(), PixelSums{0.0, 1.0});
    clean_ = true;
  }
  started_ = false;
  reference_taken_ = false;
}

void DoubleIntegral::forget() {
  clear();
  expecting_ = false;
}

void DoubleIntegral::expect(const ExposureInterval& window, std::int64_t reference_ns) {
  clear();
  expecting_ = window.length() > 0;
  expected_ = window;
  expected_reference_ns_ = reference_ns;
}

void DoubleIntegral::startAt(const PixelEventLists& lists, std::int64_t base_ns) {
  clear();
  started_ = true;
  base_ns_ = base_ns;
  base_sequence_ = lists.lowerBound(base_ns);
  cursor_ = base_sequence_;
}

void DoubleIntegral::follow(const PixelEventLists& lists) {
  if (!expecting_ || !lists.hasNewest()) {
    return;
  }
  const std::int64_t base_ns = baseInstant(expected_);
  if (!started_) {
    if (lists.newest() < base_ns) {
      return;
    }
    startAt(lists, base_ns);
  }
  if (cursor_ < lists.beginSequence()) {
    forget();  // overflow took events that were not folded in yet
    return;
  }
  if (!reference_taken_) {
    const std::int64_t stop_ns = expected_reference_ns_ - kPredictionMargin_ns;
    fold(lists, std::max(cursor_, lists.lowerBound(stop_ns)));
    if (lists.newest() < stop_ns) {
      return;
    }
    takeReference();
  }
  fold(lists, std::max(cursor_, lists.lowerBound(expected_.end_ns - kPredictionMargin_ns)));
}

bool DoubleIntegral::runningSumsServe(const PixelEventLists& lists, const WindowEvents& events,
                                      std::int64_t base_ns) const {
  return started_ && base_ns_ == base_ns && base_sequence_ == events.base &&
         base_sequence_ >= lists.beginSequence() && cursor_ <= events.end &&
         (reference_taken_ ? reference_cursor_ <= std::max(events.reference, events.base)
                           : cursor_ <= std::max(events.reference, events.base));
}

CloseReport DoubleIntegral::close(const PixelEventLists& lists, const ExposureInterval& window,
                                  std::int64_t reference_ns, float* gain) {
  const std::int64_t base_ns = baseInstant(window);
  WindowEvents events;
  events.start = lists.lowerBound(window.start_ns);
  events.base = lists.lowerBound(base_ns);
  events.reference = lists.lowerBound(reference_ns);
  events.end = lists.lowerBound(window.end_ns);

  CloseReport report;
  report.events = events.end - events.start;
  report.kind = CloseKind::kFollowed;
  if (!runningSumsServe(lists, events, base_ns)) {
    report.kind = CloseKind::kSurprise;
    startAt(lists, base_ns);
  }
  report.walked = (events.base - events.start) + (events.end - cursor_);

  if (!reference_taken_) {
    fold(lists, std::max(events.reference, events.base));
    takeReference();
  }
  extendReference(lists, events.reference);
  fold(lists, events.end);
  prepend(lists, events);

  const bool by_time = weighting_ == Weighting::kTime;
  const auto countFromBase = [&](std::uint64_t sequence) {
    return static_cast<double>(static_cast<std::int64_t>(sequence - events.base));
  };
  const double clock_start =
      by_time ? static_cast<double>(window.start_ns - base_ns) : countFromBase(events.start);
  const double clock_end =
      by_time ? static_cast<double>(window.end_ns - base_ns) : countFromBase(events.end);
  if (clock_start < clock_end) {
    report.out_of_range = takeGains(sums_.data(), reference_value_.data(), sums_.size(),
                                    {clock_start, clock_end}, gain);
    clean_ = true;
  } else {  // counter weighting, no event
    std::fill(gain, gain + sums_.size(), 1.0f);
  }
  clear();
  expecting_ = false;
  return report;
}

/// Appends the events [cursor_, end_sequence) to the running results.
void DoubleIntegral::fold(const PixelEventLists& lists, std::uint64_t end_sequence) {
  if (cursor_ >= end_sequence) {
    return;
  }
  clean_ = false;
  forEachSpan(lists, cursor_, end_sequence, [this](const PackedEventSpan& span) {
    if (weighting_ == Weighting::kTime) {
      foldByTime(span.data, span.count, span.base_ns - base_ns_, *factors_, sums_.data());
    } else {
      const auto first_clock = static_cast<std::int64_t>(span.first_sequence - base_sequence_);
      foldByCounter(span.data, span.count, first_clock, *factors_, sums_.data());
    }
  });
  cursor_ = end_sequence;
}

void DoubleIntegral::takeReference() {
  std::transform(sums_.begin(), sums_.end(), reference_value_.begin(),
                 [](const PixelSums& pixel) { return pixel.value; });
  reference_taken_ = true;
  reference_cursor_ = cursor_;
}

/// Brings the reference values forward to events [reference_cursor_, end_sequence), by the same
/// arithmetic as fold().
void DoubleIntegral::extendReference(const PixelEventLists& lists, std::uint64_t end_sequence) {
  if (reference_cursor_ >= end_sequence) {
    return;
  }
  forEachSpan(lists, reference_cursor_, end_sequence, [this](const PackedEventSpan& span) {
    for (std::size_t i = 0; i < span.count; ++i) {
      double& value = reference_value_[span.data[i].code >> 1];
      value -= value * factors_->one_minus[span.data[i].code & 1u];
    }
  });
  reference_cursor_ = end_sequence;
}

/// Puts the events between the window's start and the base instant in front, newest first.
void DoubleIntegral::prepend(const PixelEventLists& lists, const WindowEvents& events) {
  if (events.start < events.base) {
    clean_ = false;
  }
  std::uint64_t end = events.base;
  while (end > events.start) {
    // Spans run forward, so the last one before `end` is found from its beginning.
    std::uint64_t begin = events.start;
    PackedEventSpan span = lists.span(begin, end);
    while (begin + span.count < end) {
      begin += span.count;
      span = lists.span(begin, end);
    }
    const std::int64_t offset_ns = span.base_ns - base_ns_;
    for (std::size_t i = span.count; i-- > 0;) {
      const std::uint32_t code = span.data[i].code;
      const std::int64_t clock = weighting_ == Weighting::kTime
                                     ? static_cast<std::int64_t>(span.data[i].dt_ns) + offset_ns
                                     : static_cast<std::int64_t>(begin + i - base_sequence_);
      const double multiplier = factors_->multiplier[code & 1u];
      PixelSums& pixel = sums_[code >> 1];
      pixel.sum =
          multiplier * pixel.sum + factors_->one_minus[code & 1u] * static_cast<double>(clock);
      pixel.value *= multiplier;
      if (begin + i < events.reference) {
        reference_value_[code >> 1] *= multiplier;
      }
    }
    end = begin;
  }
}

}  // namespace fast_edi
