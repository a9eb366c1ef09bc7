/// \file
/// All of a recording, kept, for tests that compare it with what was written.
#pragma once

#include <gmock/gmock.h>

#include <cstdint>
#include <tuple>
#include <variant>
#include <vector>

#include "fast_edi/recording/recording.hpp"

namespace fast_edi::testing {

struct RecordingContent {
  std::vector<std::tuple<std::int64_t, int, int, bool>> events;  ///< t [ns], x, y, ON
  std::vector<RecordedFrame> frames;                             ///< without their pixels
  std::vector<std::uint8_t> pixels;                              ///< of the last frame
  std::vector<RecordedImu> samples;
  std::vector<RecordingDamage> damage;
};

/// Expects record times that never go back and no empty item.
inline RecordingContent readAll(Recording& recording) {
  RecordingContent content;
  RecordingItem item;
  std::int64_t before_ns = 0;
  while (recording.next(item)) {
    EXPECT_GE(item.record_ns, before_ns);
    before_ns = item.record_ns;
    if (const auto* events = std::get_if<RecordedEvents>(&item.content)) {
      EXPECT_GT(events->count, 0u);
      for (std::size_t i = 0; i < events->count; ++i) {
        const Event& event = events->data[i];
        content.events.emplace_back(event.t_ns, event.x, event.y, event.on);
      }
    } else if (const auto* frame = std::get_if<RecordedFrame>(&item.content)) {
      content.frames.push_back(*frame);
      content.pixels.assign(frame->pixels, frame->pixels + frame->bytes);
    } else if (const auto* sample = std::get_if<RecordedImu>(&item.content)) {
      content.samples.push_back(*sample);
    }
  }
  content.damage = recording.damage();
  return content;
}

}  // namespace fast_edi::testing
