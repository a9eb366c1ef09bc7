/// \file
/// What two recordings must share to be the same, in a form that `==` compares.
#pragma once

#include <cstdint>
#include <string>
#include <tuple>
#include <variant>
#include <vector>

#include "fast_edi/recording/recording.hpp"

namespace fast_edi::testing {

struct ComparedContent {
  using EventRow = std::tuple<std::int64_t, int, int, bool>;  ///< t [ns], x, y, ON
  /// Exposure start and end [ns], zero where unknown; encoding; pixels.
  using FrameRow = std::tuple<std::int64_t, std::int64_t, std::string, std::vector<std::uint8_t>>;

  std::vector<EventRow> events;
  std::vector<FrameRow> frames;
  std::vector<std::int64_t> samples;  ///< times of IMU samples [ns]
  std::vector<int> triggers;          ///< types
  std::size_t calibrations = 0;
  std::vector<RecordingDamage> damage;
  bool times_in_order = true;  ///< record times never go back
};

inline ComparedContent readForComparison(Recording& recording) {
  ComparedContent content;
  RecordingItem item;
  std::int64_t before_ns = 0;
  while (recording.next(item)) {
    content.times_in_order &= item.record_ns >= before_ns;
    before_ns = item.record_ns;
    if (const auto* events = std::get_if<RecordedEvents>(&item.content)) {
      for (std::size_t i = 0; i < events->count; ++i) {
        const Event& event = events->data[i];
        content.events.emplace_back(event.t_ns, event.x, event.y, event.on);
      }
    } else if (const auto* frame = std::get_if<RecordedFrame>(&item.content)) {
      const ExposureInterval exposure = frame->exposure.value_or(ExposureInterval{});
      content.frames.emplace_back(
          exposure.start_ns, exposure.end_ns, frame->encoding,
          std::vector<std::uint8_t>(frame->pixels, frame->pixels + frame->bytes));
    } else if (const auto* sample = std::get_if<RecordedImu>(&item.content)) {
      content.samples.push_back(sample->t_ns);
    } else if (const auto* trigger = std::get_if<RecordedTrigger>(&item.content)) {
      content.triggers.push_back(trigger->type);
    } else if (std::holds_alternative<RecordedCalibration>(item.content)) {
      ++content.calibrations;
    }
  }
  content.damage = recording.damage();
  return content;
}

}  // namespace fast_edi::testing
