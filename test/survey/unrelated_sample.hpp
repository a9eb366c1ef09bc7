/// \file
/// Frames and events that have nothing to do with each other.
#pragma once

#include <cstdint>
#include <memory>
#include <random>

#include "survey/timing_sample.hpp"

namespace fast_edi::testing {

/// Two frames of 20 ms and 300 ms of events, 40x30.
inline TimingSample unrelatedSample(unsigned seed) {
  constexpr SensorSize kSize{40, 30};
  constexpr std::int64_t kMs = kNanosecondsPerMillisecond;
  std::mt19937 random(seed);
  TimingSample sample;
  sample.events = std::make_unique<PixelEventLists>(kSize, PixelEventLists::Limits{});
  sample.events->keepIntervals(true);
  for (std::int64_t t_ns = 0; t_ns < 300 * kMs; t_ns += 20'000) {
    sample.events->append(Event{static_cast<std::uint16_t>(random() % 40),
                                static_cast<std::uint16_t>(random() % 30), t_ns,
                                random() % 2 == 0});
  }
  std::int64_t stamp_ns = 130 * kMs;
  for (SampledFrame* frame : {&sample.first, &sample.second}) {
    frame->stamp_ns = stamp_ns;
    frame->length_ns = 20 * kMs;
    stamp_ns += 40 * kMs;
    for (std::size_t i = 0; i < kSize.pixelCount(); ++i) {
      frame->levels.push_back(static_cast<std::uint8_t>(50 + random() % 100));
    }
    frame->size = kSize;
    readExposure(*frame, SampleGrid{kSize, 1}, EventOrientation::kNormal);
  }
  return sample;
}

}  // namespace fast_edi::testing
