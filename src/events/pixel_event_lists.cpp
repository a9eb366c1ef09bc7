#include "fast_edi/events/pixel_event_lists.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "events/wire_block.hpp"

namespace fast_edi {
namespace {

constexpr int kMaxSide_px = 32767;         // signed 16-bit arithmetic computes pixel indices
constexpr std::size_t kBlockEvents = 128;  // stays in the first-level cache between stages
/// After an irregular one, blocks begin small: where irregular records come again and again, blocks
/// that turn out to hold one cost little.
constexpr std::size_t kSmallestBlock = 2 * kWireBlockStride;

/// Unused chunks that are kept whatever was in use before.
constexpr std::size_t kSpareChunks = 4;
/// By one part in so many the working set shrinks with each discardBefore().
constexpr std::size_t kWorkingSetDecay = 16;

std::int64_t wireSecond(const std::uint8_t* record, std::uint32_t& second) {
  const Event event = decodeWireEvent(record);
  second = static_cast<std::uint32_t>(event.t_ns / kNanosecondsPerSecond);
  return static_cast<std::int64_t>(second) * kNanosecondsPerSecond;
}

}  // namespace

// Events are written before they are read. NOLINTNEXTLINE(cppcoreguidelines-pro-type-member-init)
struct PixelEventLists::Chunk {
  std::int64_t base_ns = 0;
  std::uint64_t first_sequence = 0;
  std::size_t count = 0;
  std::vector<std::uint16_t> intervals;  ///< of the events, once they were kept
  PackedEvent events[kChunkEvents];

  std::int64_t time(std::size_t i) const { return base_ns + events[i].dt_ns; }
  std::uint64_t endSequence() const { return first_sequence + count; }
};

PixelEventLists::PixelEventLists(SensorSize size, Limits limits) {
  reset(size, limits);
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
  flush();
  block_events_ = kBlockEvents;
  keepIntervals(false);
  size_ = size;
  limits_ = limits;
  max_chunks_ = (limits.max_events + kChunkEvents - 1) / kChunkEvents + 1;
  chunks_.reserve(max_chunks_);
  free_chunks_.reserve(max_chunks_);
}

void PixelEventLists::keepIntervals(bool keep) {
  if (keep == keeps_intervals_) {
    return;
  }
  keeps_intervals_ = keep;
  if (!keep) {
    intervals_.release();
    for (auto* chunks : {&chunks_, &free_chunks_}) {
      for (const std::unique_ptr<Chunk>& chunk : *chunks) {
        chunk->intervals = {};
      }
    }
    return;
  }
  intervals_.reset(size_.pixelCount());
  for (const std::unique_ptr<Chunk>& chunk : chunks_) {
    measureIntervals(*chunk, 0, chunk->count);
  }
}

void PixelEventLists::measureIntervals(Chunk& chunk, std::size_t first, std::size_t count) {
  if (!keeps_intervals_) {
    return;
  }
  if (chunk.intervals.empty()) {
    chunk.intervals.resize(kChunkEvents);
  }
  intervals_.measure(chunk.events + first, count, chunk.base_ns, chunk.intervals.data() + first);
}

AppendResult PixelEventLists::append(const WireEvents& events) {
  AppendResult result;
  while (result.consumed < events.count) {
    const WireEvents rest = events.from(result.consumed);
    const std::size_t block = block_events_;
    const std::size_t regular = appendRegular(rest, result);
    result.consumed += regular;
    result.accepted += regular;
    if (regular > 0) {
      continue;
    }
    const std::size_t one_by_one = std::min(rest.count, block);
    for (std::size_t i = 0; i < one_by_one; ++i) {
      ++result.read;
      result.stop = appendOne(decodeWireEvent(rest.record(i)), result);
      if (result.stop != AppendStop::kNone) {
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

/// Takes in a block if all of its records are regular; returns how many that were.
std::size_t PixelEventLists::appendRegular(const WireEvents& events, AppendResult& result) {
  // The last record of an array has nothing behind it that could be read along.
  const std::size_t readable = events.count > 0 ? events.count - 1 : 0;
  if (readable < kWireBlockStride || chunks_.empty() || !has_newest_) {
    return 0;
  }
  Chunk& chunk = *chunks_.back();
  std::size_t count = std::min({readable, block_events_, kChunkEvents - chunk.count});
  count -= count % kWireBlockStride;
  if (count == 0 || eventCount() + count > limits_.max_events) {
    return 0;
  }

  RegularBlock block;
  block.size = size_;
  const std::int64_t second_dt = wireSecond(events.data, block.second) - chunk.base_ns;
  const std::int64_t newest_dt = newest_ns_ - chunk.base_ns;
  constexpr std::int64_t kMaxDt = std::numeric_limits<std::int32_t>::max();
  if (second_dt < -kMaxDt || second_dt + kNanosecondsPerSecond > kMaxDt || newest_dt > kMaxDt) {
    return 0;
  }
  block.second_dt_ns = static_cast<std::int32_t>(second_dt);
  block.previous_dt_ns = static_cast<std::int32_t>(newest_dt);
  PackedEvent* out = chunk.events + chunk.count;
  result.read += count;
  if (!unpackRegularBlock(events.data, count, block, out)) {
    block_events_ = kSmallestBlock;
    return 0;
  }
  const std::int64_t block_newest_ns = chunk.base_ns + out[count - 1].dt_ns;
  if (block_newest_ns - newest_ns_ > limits_.max_forward_jump_ns) {
    block_events_ = kSmallestBlock;
    return 0;
  }
  block_events_ = std::min(2 * block_events_, kBlockEvents);
  measureIntervals(chunk, chunk.count, count);
  newest_ns_ = block_newest_ns;
  chunk.count += count;
  end_sequence_ += count;
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
  makeRoom(1);
  Chunk& chunk = chunkFor(event.t_ns);
  const std::uint32_t index =
      static_cast<std::uint32_t>(event.y) * static_cast<std::uint32_t>(size_.width) + event.x;
  chunk.events[chunk.count] = {static_cast<std::uint32_t>(event.t_ns - chunk.base_ns),
                               2 * index + (event.on ? 1u : 0u)};
  measureIntervals(chunk, chunk.count, 1);
  ++chunk.count;
  ++end_sequence_;
  newest_ns_ = event.t_ns;
  has_newest_ = true;
  ++result.consumed;
  ++result.accepted;
  return AppendStop::kNone;
}

/// The chunk that takes the next event: the newest one, or a new one when it is full or too old for
/// 32-bit times.
PixelEventLists::Chunk& PixelEventLists::chunkFor(std::int64_t t_ns) {
  constexpr std::int64_t kMaxDt = std::numeric_limits<std::int32_t>::max();
  if (!chunks_.empty()) {
    Chunk& newest = *chunks_.back();
    if (newest.count < kChunkEvents && t_ns - newest.base_ns <= kMaxDt) {
      return newest;
    }
    if (chunks_.size() == max_chunks_) {
      overflowed_ += chunks_.front()->count;
      dropFront();
    }
  }
  if (free_chunks_.empty()) {
    // Not value-initialised: half a megabyte of zeros would be written for nothing.
    chunks_.emplace_back(new Chunk);
  } else {
    chunks_.push_back(std::move(free_chunks_.back()));
    free_chunks_.pop_back();
  }
  Chunk& chunk = *chunks_.back();
  chunk.base_ns = t_ns;
  chunk.first_sequence = end_sequence_;
  chunk.count = 0;
  return chunk;
}

void PixelEventLists::makeRoom(std::size_t events) {
  while (eventCount() + events > limits_.max_events && !chunks_.empty()) {
    overflowed_ += chunks_.front()->count;
    dropFront();
  }
}

void PixelEventLists::dropFront() {
  std::unique_ptr<Chunk> front = std::move(chunks_.front());
  chunks_.erase(chunks_.begin());
  complete_from_ns_ = front->time(front->count - 1) + 1;
  begin_sequence_ = front->endSequence();
  recycle(std::move(front));
}

void PixelEventLists::recycle(std::unique_ptr<Chunk> chunk) {
  free_chunks_.push_back(std::move(chunk));
}

/// Frees unused chunks beyond the working set.
void PixelEventLists::trim() {
  while (!free_chunks_.empty() &&
         chunks_.size() + free_chunks_.size() > working_set_ + kSpareChunks) {
    free_chunks_.pop_back();
  }
}

void PixelEventLists::discardBefore(std::int64_t t_ns) {
  const std::size_t in_use = chunks_.size();
  while (!chunks_.empty() && chunks_.front()->time(chunks_.front()->count - 1) < t_ns) {
    dropFront();
  }
  const std::size_t decay = (working_set_ + kWorkingSetDecay - 1) / kWorkingSetDecay;
  working_set_ = std::max(in_use, working_set_ - decay);
  trim();
}

void PixelEventLists::flush() {
  while (!chunks_.empty()) {
    recycle(std::move(chunks_.back()));
    chunks_.pop_back();
  }
  working_set_ = 0;
  trim();
  begin_sequence_ = end_sequence_;
  complete_from_ns_ = INT64_MIN;
  has_newest_ = false;
  if (keeps_intervals_) {
    intervals_.reset(size_.pixelCount());
  }
}

std::size_t PixelEventLists::memoryBytes() const {
  std::size_t bytes = (chunks_.size() + free_chunks_.size()) * sizeof(Chunk);
  for (const auto* chunks : {&chunks_, &free_chunks_}) {
    for (const std::unique_ptr<Chunk>& chunk : *chunks) {
      bytes += chunk->intervals.capacity() * sizeof(std::uint16_t);
    }
  }
  return bytes + intervals_.memoryBytes();
}

std::uint64_t PixelEventLists::lowerBound(std::int64_t t_ns) const {
  const auto chunk = std::partition_point(
      chunks_.begin(), chunks_.end(),
      [t_ns](const auto& candidate) { return candidate->time(candidate->count - 1) < t_ns; });
  if (chunk == chunks_.end()) {
    return end_sequence_;
  }
  const Chunk& found = **chunk;
  const PackedEvent* event =
      std::partition_point(found.events, found.events + found.count, [&](const PackedEvent& e) {
        return found.base_ns + static_cast<std::int64_t>(e.dt_ns) < t_ns;
      });
  return found.first_sequence + static_cast<std::uint64_t>(event - found.events);
}

std::size_t PixelEventLists::chunkIndex(std::uint64_t sequence) const {
  const auto chunk = std::partition_point(
      chunks_.begin(), chunks_.end(),
      [sequence](const auto& candidate) { return candidate->endSequence() <= sequence; });
  return static_cast<std::size_t>(chunk - chunks_.begin());
}

PackedEventSpan PixelEventLists::span(std::uint64_t sequence, std::uint64_t end_sequence) const {
  PackedEventSpan result;
  if (sequence < begin_sequence_ || sequence >= std::min(end_sequence, end_sequence_)) {
    return result;
  }
  const Chunk& chunk = *chunks_[chunkIndex(sequence)];
  const std::size_t offset = static_cast<std::size_t>(sequence - chunk.first_sequence);
  result.data = chunk.events + offset;
  if (keeps_intervals_) {
    result.intervals = chunk.intervals.data() + offset;
  }
  result.count = static_cast<std::size_t>(std::min(end_sequence, chunk.endSequence()) - sequence);
  result.base_ns = chunk.base_ns;
  result.first_sequence = sequence;
  return result;
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
