/// \file
/// Events of each pixel in the two quarters of an exposure after its middle, counted while they
/// come: so EventChanges need not read the events again when the frame is closed.
///
/// As EventCounts, whole numbers that depend on the exposure alone, not on what was predicted.
#pragma once

#include <cstddef>
#include <cstdint>

#include "fast_edi/base/types.hpp"
#include "fast_edi/events/event_counts.hpp"
#include "fast_edi/events/pixel_event_lists.hpp"

namespace fast_edi {

class LaterQuarters {
 public:
  explicit LaterQuarters(SensorSize size) : third_(size), fourth_(size) {}

  /// Where the last quarter begins.
  static std::int64_t lateInstant(const ExposureInterval& window) {
    constexpr std::int64_t kQuarters = 4;
    return window.end_ns - window.length() / kQuarters;
  }

  /// Discards all counts. Must be called when the lists were flushed or reset.
  void reset() {
    third_.reset();
    fourth_.reset();
  }
  /// Counts what the lists hold of the coming exposure, in event time.
  void accumulate(const PixelEventLists& lists, const ExposureInterval& window) {
    third_.accumulate(lists, thirdOf(window));
    fourth_.accumulate(lists, fourthOf(window));
  }
  /// Counts the events of the exposure.
  void count(const PixelEventLists& lists, const ExposureInterval& window) {
    third_.count(lists, thirdOf(window));
    fourth_.count(lists, fourthOf(window));
  }

  /// Of the last count(), from the middle to lateInstant(), and from there to the end.
  const EventCounts& third() const { return third_; }
  const EventCounts& fourth() const { return fourth_; }

  std::size_t memoryBytes() const { return third_.memoryBytes() + fourth_.memoryBytes(); }

 private:
  static ExposureInterval thirdOf(const ExposureInterval& window) {
    return {window.at(ExposureInstant::kMid), lateInstant(window)};
  }
  static ExposureInterval fourthOf(const ExposureInterval& window) {
    return {lateInstant(window), window.end_ns};
  }

  EventCounts third_;
  EventCounts fourth_;
};

}  // namespace fast_edi
