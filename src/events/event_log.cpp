#include "fast_edi/events/event_log.hpp"

#include <algorithm>
#include <utility>

namespace fast_edi {
namespace {

/// Unused chunks that are kept whatever was in use before.
constexpr std::size_t kSpareChunks = 4;
/// By one part in so many the working set shrinks with each discardBefore().
constexpr std::size_t kWorkingSetDecay = 16;

}  // namespace

void EventLog::reset(std::size_t pixels, std::size_t max_events) {
  flush();
  keepIntervals(false);
  pixels_ = pixels;
  max_events_ = max_events;
  max_chunks_ = (max_events + kChunkEvents - 1) / kChunkEvents + 1;
  chunks_.reserve(max_chunks_);
  free_chunks_.reserve(max_chunks_);
}

void EventLog::flush() {
  while (!chunks_.empty()) {
    recycle(std::move(chunks_.back()));
    chunks_.pop_back();
  }
  working_set_ = 0;
  trim();
  begin_sequence_ = end_sequence_;
  complete_from_ns_ = INT64_MIN;
  if (keeps_intervals_) {
    intervals_.reset(pixels_);
  }
}

void EventLog::discardBefore(std::int64_t t_ns) {
  const std::size_t in_use = chunks_.size();
  while (!chunks_.empty() && chunks_.front()->newest() < t_ns) {
    dropFront();
  }
  const std::size_t decay = (working_set_ + kWorkingSetDecay - 1) / kWorkingSetDecay;
  working_set_ = std::max(in_use, working_set_ - decay);
  trim();
}

/// Frees unused chunks beyond the working set.
void EventLog::trim() {
  while (!free_chunks_.empty() &&
         chunks_.size() + free_chunks_.size() > working_set_ + kSpareChunks) {
    free_chunks_.pop_back();
  }
}

void EventLog::keepIntervals(bool keep) {
  if (keep == keeps_intervals_) {
    return;
  }
  keeps_intervals_ = keep;
  unshare();
  if (!keep) {
    intervals_.release();
    for (auto* chunks : {&chunks_, &free_chunks_}) {
      for (const std::shared_ptr<Chunk>& chunk : *chunks) {
        chunk->intervals = {};
      }
    }
    return;
  }
  intervals_.reset(pixels_);
  for (const std::shared_ptr<Chunk>& chunk : chunks_) {
    measureIntervals(*chunk, 0, chunk->count);
  }
}

void EventLog::measureIntervals(Chunk& chunk, std::size_t first, std::size_t count) {
  if (chunk.intervals.empty()) {
    chunk.intervals.resize(kChunkEvents);
  }
  intervals_.measure(chunk.events + first, count, chunk.base_ns, chunk.intervals.data() + first);
}

/// Lets the newest chunk have room for an event of time \p t_ns.
void EventLog::makeRoom(std::int64_t t_ns) {
  while (!fits(1) && !chunks_.empty()) {
    overflow();
  }
  if (newestTakes(t_ns)) {
    return;
  }
  if (chunks_.size() == max_chunks_) {
    overflow();
  }
  beginChunk(t_ns);
}

void EventLog::beginChunk(std::int64_t t_ns) {
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
}

/// Drops the oldest chunk for want of room.
void EventLog::overflow() {
  overflowed_ += chunks_.front()->count;
  dropFront();
}

void EventLog::dropFront() {
  std::shared_ptr<Chunk> front = std::move(chunks_.front());
  chunks_.erase(chunks_.begin());
  complete_from_ns_ = front->newest() + 1;
  begin_sequence_ = front->endSequence();
  recycle(std::move(front));
}

/// Keeps a chunk's memory for later, unless another log may still read it.
void EventLog::recycle(std::shared_ptr<Chunk> chunk) {
  if (!chunk->is_shared) {
    free_chunks_.push_back(std::move(chunk));
  }
}

void EventLog::share(const EventLog& other, std::int64_t from_ns, std::int64_t to_ns) {
  chunks_.clear();
  pixels_ = other.pixels_;
  max_events_ = other.max_events_;
  keeps_intervals_ = other.keeps_intervals_;
  complete_from_ns_ = other.complete_from_ns_;
  begin_sequence_ = other.end_sequence_;
  end_sequence_ = other.end_sequence_;
  for (const std::shared_ptr<Chunk>& chunk : other.chunks_) {
    if (chunk->newest() < from_ns || chunk->time(0) >= to_ns) {
      continue;
    }
    if (chunk == other.chunks_.back()) {
      chunks_.push_back(copyOf(*chunk));  // it grows
    } else {
      chunk->is_shared = true;
      chunks_.push_back(chunk);
    }
  }
  if (!chunks_.empty()) {
    begin_sequence_ = chunks_.front()->first_sequence;
    end_sequence_ = chunks_.back()->endSequence();
  }
}

std::shared_ptr<EventLog::Chunk> EventLog::copyOf(const Chunk& chunk) {
  std::shared_ptr<Chunk> copy(new Chunk);
  copy->base_ns = chunk.base_ns;
  copy->first_sequence = chunk.first_sequence;
  copy->count = chunk.count;
  std::copy(chunk.events, chunk.events + chunk.count, copy->events);
  if (!chunk.intervals.empty()) {
    copy->intervals.resize(kChunkEvents);
    std::copy_n(chunk.intervals.begin(), chunk.count, copy->intervals.begin());
  }
  return copy;
}

/// Makes all chunks this log's own, before they are written to.
void EventLog::unshare() {
  for (std::shared_ptr<Chunk>& chunk : chunks_) {
    if (chunk->is_shared) {
      chunk = copyOf(*chunk);
    }
  }
}

std::size_t EventLog::memoryBytes() const {
  std::size_t bytes = (chunks_.size() + free_chunks_.size()) * sizeof(Chunk);
  for (const auto* chunks : {&chunks_, &free_chunks_}) {
    for (const std::shared_ptr<Chunk>& chunk : *chunks) {
      bytes += chunk->intervals.capacity() * sizeof(std::uint16_t);
    }
  }
  return bytes + intervals_.memoryBytes();
}

std::uint64_t EventLog::lowerBound(std::int64_t t_ns) const {
  const auto chunk =
      std::partition_point(chunks_.begin(), chunks_.end(),
                           [t_ns](const auto& candidate) { return candidate->newest() < t_ns; });
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

std::size_t EventLog::chunkIndex(std::uint64_t sequence) const {
  const auto chunk = std::partition_point(
      chunks_.begin(), chunks_.end(),
      [sequence](const auto& candidate) { return candidate->endSequence() <= sequence; });
  return static_cast<std::size_t>(chunk - chunks_.begin());
}

PackedEventSpan EventLog::span(std::uint64_t sequence, std::uint64_t end_sequence) const {
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

}  // namespace fast_edi
