/// \file
/// What the fuzzers of recordings do with their input: a file in memory, read as items and as the
/// messages that the tools get of it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <variant>

#include "fast_edi/bags/recording_messages.hpp"
#include "fast_edi/exposure/stamp_limits.hpp"
#include "fast_edi/recording/recording.hpp"
#include "fast_edi/recording/recording_error.hpp"
#include "fuzz/fuzzing.hpp"
#include "fuzz/memory_file.hpp"

namespace fast_edi::fuzzing {

/// Touches each byte that an item points to.
inline std::size_t sumOf(const RecordingItem& item) {
  std::size_t sum = 0;
  if (const auto* events = std::get_if<RecordedEvents>(&item.content)) {
    for (std::size_t i = 0; i < events->count; ++i) {
      require(isStamp(events->data[i].t_ns), "times of events can be stamped");
      sum += events->data[i].x;
    }
  } else if (const auto* frame = std::get_if<RecordedFrame>(&item.content)) {
    require(isStamp(frame->stamp_ns), "times of frames can be stamped");
    require(frame->size.width > 0 && frame->size.height > 0, "frames have a size");
    for (std::size_t i = 0; i < frame->bytes; ++i) {
      sum += frame->pixels[i];
    }
  }
  return sum;
}

inline void readItems(Recording& recording) {
  RecordingItem item;
  std::int64_t before_ns = 0;
  std::size_t sum = 0;
  while (recording.next(item)) {
    require(item.record_ns >= before_ns, "record times never go back");
    require(item.stream < recording.streams().size(), "items belong to a stream");
    before_ns = item.record_ns;
    sum += sumOf(item);
  }
  require(sum < SIZE_MAX, "all was read");
  for (const RecordingDamage& damage : recording.damage()) {
    require(!damage.what.empty(), "damage says what it is");
  }
}

inline void readMessages(std::unique_ptr<Recording> recording) {
  RecordingMessages messages(std::move(recording), 10 * kNanosecondsPerMillisecond);
  BagMessage message;
  while (messages.next(message)) {
    require(message.connection != nullptr, "messages have a topic");
  }
}

/// \param open may give none
inline void readTwice(const std::function<std::unique_ptr<Recording>()>& open) {
  try {
    if (const std::unique_ptr<Recording> recording = open()) {
      readItems(*recording);
      readMessages(open());
    }
  } catch (const RecordingError& error) {
    require(*error.what() != '\0', "a refusal says why");
  }
}

}  // namespace fast_edi::fuzzing
