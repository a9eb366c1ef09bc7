#include "fast_edi/events/event_stream.hpp"
#include "fast_edi/base/sensor_size.hpp"

#include <algorithm>
#include <utility>

namespace fast_edi {
namespace {

/// Jumps that one array's held events may make. More, and the rest of them are no clock's.
constexpr int kMostHeldJumps = 2;

std::int64_t timeOf(const WireEvents& events, std::size_t index) {
  return decodeWireEvent(events.record(index)).t_ns;
}

WireEvents viewOf(const std::vector<std::uint8_t>& bytes) {
  return {bytes.data(), bytes.size() / kWireEventBytes};
}

bool isValid(SensorSize size) {
  return size.width >= 1 && size.width <= kMaxSide_px && size.height >= 1 &&
         size.height <= kMaxSide_px;
}

}  // namespace

EventStream::EventStream(PixelEventLists::Limits limits, DeblurCounters& counters,
                         ResetHandler before_reset)
    : limits_(limits), counters_(counters), before_reset_(std::move(before_reset)) {}

void EventStream::take(const WireEvents& events, SensorSize size,
                       std::optional<std::uint32_t> sequence) {
  ++counters_.event_arrays;
  counters_.events_in += events.count;
  stopped_ = false;
  if (isRepeated(events, size)) {
    ++counters_.event_arrays_repeated;
    counters_.events_repeated += events.count;
    if (sequence && !sequence_gaps_.isLast(*sequence)) {
      sequence_gaps_.restart();
    }
    return;
  }
  const bool refused = !isValid(size);
  const SequenceStep step =
      sequence ? sequence_gaps_.step(*sequence) : SequenceStep::kNothingMissing;
  counters_.event_array_gaps += step == SequenceStep::kGap ? 1 : 0;
  counters_.event_arrays_missing += step == SequenceStep::kGap ? sequence_gaps_.missing() : 0;
  counters_.event_restarts += step == SequenceStep::kRestart ? 1 : 0;
  arrays_missing_ =
      arrays_missing_ || step != SequenceStep::kNothingMissing || (refused && !events.empty());
  markMissingArrays();
  if (refused) {
    ++counters_.event_arrays_refused;
    counters_.events_refused += events.count;
    return;
  }

  setSize(size, events);
  if (events.empty()) {
    return;
  }
  for (int jumps = 0; !held_.empty() && jumps < kMostHeldJumps; ++jumps) {
    resolveHeldJump(timeOf(events, 0));
  }
  dropHeld();
  markMissingArrays();  // once more: there may be a new epoch
  arrays_missing_ = false;
  ingest(events, true);
  recent_arrays_.add(events);
}

bool EventStream::isRepeated(const WireEvents& events, SensorSize size) const {
  if (events.empty() || !lists_ || lists_->size() != size) {
    return false;
  }
  // Looked for only where it can be: most arrays are newer than all before them.
  const bool is_near =
      lists_->hasNewest() && timeOf(events, 0) <= lists_->newest() &&
      timeOf(events, events.count - 1) >= lists_->newest() - limits_.max_backward_jump_ns;
  return (is_near || !held_.empty()) && recent_arrays_.contains(events);
}

void EventStream::noteLost(std::size_t events) {
  counters_.events_in += events;
  counters_.events_overflowed += events;
  sequence_gaps_.restart();  // the hole that follows in their numbers is this one
  arrays_missing_ = true;
  markMissingArrays();
}

void EventStream::noteMissing() {
  stopped_ = true;
  arrays_missing_ = true;
  markMissingArrays();
}

void EventStream::markMissingArrays() {
  if (arrays_missing_ && lists_ && lists_->hasNewest()) {
    coverage_.openHole(lists_->newest());
  }
}

void EventStream::setSize(SensorSize size, const WireEvents& next) {
  seen_ = true;
  if (!lists_) {
    lists_ = std::make_unique<PixelEventLists>(size, limits_);
    return;
  }
  if (lists_->size() == size) {
    return;
  }
  ++counters_.size_changes;
  dropHeld();
  if (lists_->hasNewest() && !next.empty()) {
    const std::int64_t next_ns = timeOf(next, 0);
    // The clock goes on, so nothing is missing up to the new array, unless the array's time is odd.
    if (!coverage_.holeOpen() && next_ns - lists_->newest() <= limits_.max_forward_jump_ns) {
      next_event_ns_ = next_ns;
    }
    before_reset_(StreamReset::kSizeChange, next_ns);
    next_event_ns_ = INT64_MIN;
  }
  flush();
  lists_->reset(size, limits_);
}

/// \param next_array_ns time of the first event of the array that decides
void EventStream::resolveHeldJump(std::int64_t next_array_ns) {
  const WireEvents held = viewOf(held_);
  if (!held_jump_.continues(timeOf(held, held.count - 1), next_array_ns)) {
    dropHeld();
    return;
  }
  const std::vector<std::uint8_t> confirmed = std::exchange(held_, {});
  beginEpoch(timeOf(viewOf(confirmed), 0));
  ingest(viewOf(confirmed), false);
}

/// \param may_jump whether a jump back may be taken for granted, once
void EventStream::ingest(WireEvents events, bool may_jump) {
  while (!events.empty()) {
    const std::uint64_t first_new = lists_->endSequence();
    const std::uint64_t overflowed_before = lists_->overflowed();
    const AppendResult result = lists_->append(events);
    records_read_ += result.read;
    counters_.events_late += result.late;
    counters_.events_outside += result.outside;
    counters_.events_overflowed += lists_->overflowed() - overflowed_before;
    if (result.accepted > 0) {
      noteAccepted(first_new);
    }
    events = events.from(result.consumed);
    if (result.stop == AppendStop::kNone) {
      return;
    }

    const TimeJump jump{lists_->newest(), result.stop == AppendStop::kForwardJump,
                        limits_.max_forward_jump_ns};
    const std::size_t run = jump.runLength(events);
    records_read_ += run;
    if (run < events.count) {
      counters_.events_glitched += run;
      events = events.from(run);
    } else if (may_jump && !jump.forward && run > 1) {
      may_jump = false;  // looking ahead to the end again and again would take quadratic time
      beginEpoch(timeOf(events, 0));
    } else {
      held_.assign(events.data, events.data + events.count * kWireEventBytes);
      held_jump_ = jump;
      return;
    }
  }
}

/// \param sequence of the first event that was just accepted
void EventStream::noteAccepted(std::uint64_t sequence) {
  if (coverage_.started() && !coverage_.holeOpen()) {
    return;
  }
  // An array larger than max_buffered_events may have pushed out its own beginning.
  const std::uint64_t first = std::max(sequence, lists_->beginSequence());
  const PackedEventSpan span = lists_->span(first, first + 1);
  const std::int64_t first_ns = span.base_ns + span.data[0].dt_ns;
  if (!coverage_.started()) {
    coverage_.start(first_ns);
  } else {
    coverage_.closeHole(first_ns);
  }
}

void EventStream::beginEpoch(std::int64_t first_event_ns) {
  ++counters_.event_time_jumps;
  before_reset_(StreamReset::kTimeJump, first_event_ns);
  flush();
}

void EventStream::flush() {
  lists_->flush();
  recent_arrays_.clear();
  coverage_.reset();
  ++generation_;
}

void EventStream::dropHeld() {
  counters_.events_glitched += viewOf(held_).count;
  held_.clear();
}

void EventStream::restart() {
  dropHeld();
  if (lists_) {
    flush();
  }
  seen_ = false;
  stopped_ = false;
  arrays_missing_ = false;
  sequence_gaps_.restart();
}

void EventStream::setLimits(PixelEventLists::Limits limits) {
  const bool same = limits.max_events == limits_.max_events &&
                    limits.max_backward_jump_ns == limits_.max_backward_jump_ns &&
                    limits.max_forward_jump_ns == limits_.max_forward_jump_ns;
  limits_ = limits;
  if (lists_ && !same) {
    dropHeld();
    flush();
    lists_->reset(lists_->size(), limits_);
  }
}

void EventStream::discardBefore(std::int64_t t_ns) {
  if (lists_ && lists_->hasNewest()) {
    lists_->discardBefore(t_ns);
    coverage_.discardBefore(t_ns);
  }
}

bool EventStream::hasReached(std::int64_t t_ns) const {
  return (lists_ && lists_->hasNewest() && lists_->newest() >= t_ns) || next_event_ns_ >= t_ns;
}

bool EventStream::isPast(std::int64_t t_ns) const {
  return lists_ && lists_->hasNewest() && lists_->newest() > t_ns;
}

bool EventStream::covers(const ExposureInterval& interval) const {
  return coverage_.covers(interval) && interval.start_ns >= lists_->completeFrom();
}

std::size_t EventStream::memoryBytes() const {
  return (lists_ ? lists_->memoryBytes() : 0) + held_.capacity() + sizeof(recent_arrays_);
}

}  // namespace fast_edi
