#include "fast_edi/events/pixel_event_lists.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "events/wire_block.hpp"
#include "fast_edi/base/sensor_size.hpp"

namespace fast_edi {
namespace {

constexpr std::size_t kBlockEvents = 128;  // stays in the first-level cache between stages
/// After an irregular one, blocks begin small: where irregular records come again and again, blocks
/// that turn out to hold one cost little.
constexpr std::size_t kSmallestBlock = 2 * kWireBlockStride;
/// The more blocks in a row were not regular, the more records are taken one by one before the next
/// one, up to this many: where no block is regular, trying them costs next to nothing.
constexpr std::size_t kMostOneByOne = kBlockEvents;

std::int64_t wireSecond(const std::uint8_t* record, std::uint32_t& second) {
  const Event event = decodeWireEvent(record);
  second = static_cast<std::uint32_t>(event.t_ns / kNanosecondsPerSecond);
  return static_cast<std::int64_t>(second) * kNanosecondsPerSecond;
}

}  // namespace

PixelEventLists::PixelEventLists(SensorSize size, Limits limits) {
  reset(size, limits);
}

PixelEventLists::PixelEventLists(const PixelEventLists& other, const ExposureInterval& window)
    : size_(other.size_),
      limits_(other.limits_),
      newest_ns_(other.newest_ns_),
      has_newest_(other.has_newest_) {
  log_.share(other.log_, window.start_ns, window.end_ns);
}

PixelEventLists::~PixelEventLists() = default;

void PixelEventLists::reset(SensorSize size, Limits limits) {
  if (size.width < 1 || size.height < 1 || size.width > kMaxSide_px || size.height > kMaxSide_px) {
    throw std::invalid_argument("sensor size is " + std::to_string(size.width) + " x " +
                                std::to_string(size.height) + " px, expected 1.." +
                                std::to_string(kMaxSide_px) + " on each side");
  }
  if (limits.max_events < 1 || limits.max_backward_jump_ns <= 0 ||
      limits.max_forward_jump_ns <= 0) {
    throw std::invalid_argument("limits of the event lists must all be greater than 0");
  }
  has_newest_ = false;
  block_events_ = kBlockEvents;
  one_by_one_ = 0;
  distrust_ = 0;
  size_ = size;
  limits_ = limits;
  log_.reset(size.pixelCount(), limits.max_events);
}

void PixelEventLists::flush() {
  log_.flush();
  has_newest_ = false;
}

AppendResult PixelEventLists::append(const WireEvents& events) {
  AppendResult result;
  while (result.consumed < events.count) {
    const WireEvents rest = events.from(result.consumed);
    if (one_by_one_ == 0) {
      const std::size_t regular = appendRegular(rest, result);
      if (regular > 0) {
        result.consumed += regular;
        result.accepted += regular;
        continue;
      }
    }
    one_by_one_ = std::min(rest.count, one_by_one_);
    for (std::size_t i = 0; one_by_one_ > 0; ++i) {
      --one_by_one_;
      ++result.read;
      result.stop = appendOne(decodeWireEvent(rest.record(i)), result);
      if (result.stop != AppendStop::kNone) {
        // Found what was irregular: what follows may be regular again.
        one_by_one_ = std::min(one_by_one_, distrust_);
        return result;
      }
    }
  }
  return result;
}

AppendResult PixelEventLists::append(const Event& event) {
  AppendResult result;
  result.stop = appendOne(event, result);
  return result;
}

/// Takes in a block if all of its records are regular; returns how many that were. If none, it sets
/// how many to take one by one.
std::size_t PixelEventLists::appendRegular(const WireEvents& events, AppendResult& result) {
  one_by_one_ = block_events_;
  // The last record of an array has nothing behind it that could be read along.
  const std::size_t readable = events.count > 0 ? events.count - 1 : 0;
  if (readable < kWireBlockStride || log_.empty() || !has_newest_) {
    return 0;
  }
  const EventLog::Tail tail = log_.tail();
  std::size_t count = std::min({readable, block_events_, tail.room});
  count -= count % kWireBlockStride;
  if (count == 0 || !log_.fits(count)) {
    return 0;
  }

  RegularBlock block;
  block.size = size_;
  const std::int64_t second_dt = wireSecond(events.data, block.second) - tail.base_ns;
  const std::int64_t newest_dt = newest_ns_ - tail.base_ns;
  constexpr std::int64_t kMaxDt = EventLog::kMaxDt_ns;
  if (second_dt < -kMaxDt || second_dt + kNanosecondsPerSecond > kMaxDt || newest_dt > kMaxDt) {
    return 0;
  }
  block.second_dt_ns = static_cast<std::int32_t>(second_dt);
  block.previous_dt_ns = static_cast<std::int32_t>(newest_dt);
  result.read += count;
  const bool regular = unpackRegularBlock(events.data, count, block, tail.events);
  const std::int64_t block_newest_ns = tail.base_ns + tail.events[count - 1].dt_ns;
  if (!regular || block_newest_ns - newest_ns_ > limits_.max_forward_jump_ns) {
    block_events_ = kSmallestBlock;
    one_by_one_ = std::max(one_by_one_, distrust_);
    distrust_ = std::clamp(2 * distrust_, kSmallestBlock, kMostOneByOne);
    return 0;
  }
  block_events_ = std::min(2 * block_events_, kBlockEvents);
  one_by_one_ = 0;
  distrust_ = 0;
  log_.extend(count);
  newest_ns_ = block_newest_ns;
  return count;
}

AppendStop PixelEventLists::appendOne(const Event& event, AppendResult& result) {
  if (event.x >= size_.width || event.y >= size_.height) {
    ++result.consumed;
    ++result.outside;
    return AppendStop::kNone;
  }
  if (has_newest_) {
    const std::int64_t ahead_ns = event.t_ns - newest_ns_;
    if (ahead_ns < -limits_.max_backward_jump_ns) {
      return AppendStop::kBackwardJump;
    }
    if (ahead_ns > limits_.max_forward_jump_ns) {
      return AppendStop::kForwardJump;
    }
    if (ahead_ns < 0) {
      ++result.consumed;
      ++result.late;
      return AppendStop::kNone;
    }
  }
  const EventLog::Tail tail = log_.tailFor(event.t_ns);
  const std::uint32_t index =
      static_cast<std::uint32_t>(event.y) * static_cast<std::uint32_t>(size_.width) + event.x;
  *tail.events = {static_cast<std::uint32_t>(event.t_ns - tail.base_ns),
                  2 * index + (event.on ? 1u : 0u)};
  log_.extend(1);
  newest_ns_ = event.t_ns;
  has_newest_ = true;
  ++result.consumed;
  ++result.accepted;
  return AppendStop::kNone;
}

std::vector<ListEntry> PixelEventLists::list(int x, int y, const ExposureInterval& window,
                                             const ContrastThresholds& thresholds) const {
  std::vector<ListEntry> entries;
  const auto pixel = static_cast<std::uint32_t>(y * size_.width + x);
  const std::uint64_t first = lowerBound(window.start_ns);
  const std::uint64_t end = lowerBound(window.end_ns);
  double log_value = 0.0;
  std::uint64_t sequence = first;
  while (sequence < end) {
    const PackedEventSpan events = span(sequence, end);
    for (std::size_t i = 0; i < events.count; ++i) {
      if (events.data[i].code / 2 != pixel) {
        continue;
      }
      log_value += thresholds.step((events.data[i].code & 1u) != 0);
      entries.push_back({std::exp(log_value), static_cast<std::int64_t>(sequence + i - first),
                         events.base_ns + static_cast<std::int64_t>(events.data[i].dt_ns)});
    }
    sequence += events.count;
  }
  return entries;
}

}  // namespace fast_edi
