#include "fast_edi/events/event_counts.hpp"

#include <algorithm>

namespace fast_edi {
namespace {

/// Adds \p sign to the counts of the events [begin, end) of the log.
void addRange(const PixelEventLists& lists, std::uint64_t begin, std::uint64_t end,
              std::uint16_t sign, std::uint16_t* counts) {
  while (begin < end) {
    const PackedEventSpan span = lists.span(begin, end);
    for (std::size_t i = 0; i < span.count; ++i) {
      std::uint16_t& count = counts[span.data[i].code];
      count = static_cast<std::uint16_t>(count + sign);
    }
    begin += span.count;
  }
}

constexpr std::uint16_t kOneMore = 1;
constexpr std::uint16_t kOneLess = 0xFFFF;  // modulo 65536

}  // namespace

void EventCounts::reset() {
  std::fill(counts_.begin(), counts_.end(), std::uint16_t{0});
  begin_ = 0;
  end_ = 0;
}

void EventCounts::accumulate(const PixelEventLists& lists, const ExposureInterval& window) {
  moveTo(lists, lists.lowerBound(window.start_ns), lists.lowerBound(window.end_ns));
}

void EventCounts::count(const PixelEventLists& lists, const ExposureInterval& window) {
  moveTo(lists, lists.lowerBound(window.start_ns), lists.lowerBound(window.end_ns));
}

/// Moves the counted range to [begin, end), or restarts where that is less work or where events
/// that would have to be taken away are gone from the log.
void EventCounts::moveTo(const PixelEventLists& lists, std::uint64_t begin, std::uint64_t end) {
  const std::uint64_t common_begin = std::max(begin, begin_);
  const std::uint64_t common_end = std::min(end, end_);
  const std::uint64_t common = common_end > common_begin ? common_end - common_begin : 0;
  const std::uint64_t surplus = (end_ - begin_) - common;
  const bool gone = surplus > 0 && begin_ < lists.beginSequence();
  if (gone || surplus > end - begin) {
    reset();
  }
  if (begin_ == end_) {
    begin_ = begin;
    end_ = begin;
  }
  addRange(lists, begin, std::min(begin_, end), kOneMore, counts_.data());
  addRange(lists, std::max(end_, begin), end, kOneMore, counts_.data());
  addRange(lists, begin_, std::min(begin, end_), kOneLess, counts_.data());
  addRange(lists, std::max(end, begin_), end_, kOneLess, counts_.data());
  begin_ = begin;
  end_ = end;
}

}  // namespace fast_edi
