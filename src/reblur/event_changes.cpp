#include "reblur/event_changes.hpp"

#include "base/vector_clones.hpp"
#include "integral/level_ramps.hpp"

namespace fast_edi {
namespace {

struct Steps {
  explicit Steps(const ContrastThresholds& thresholds)
      : off(static_cast<float>(thresholds.step(false))),
        on(static_cast<float>(thresholds.step(true))) {}

  float off;
  float on;
};

/// Counts of OFF and ON events, interleaved.
struct Counts {
  const std::uint16_t* all;
  const std::uint16_t* third;   ///< quarter
  const std::uint16_t* fourth;  ///< quarter
};

/// Changes from the middle to the start, to the later instant and to the end by whole steps.
FAST_EDI_VECTOR_CLONES
void sumSteps(const Counts& counts, const Steps& steps, std::size_t pixels, float* __restrict start,
              float* __restrict late, float* __restrict end) {
  const std::uint16_t* __restrict all = counts.all;
  const std::uint16_t* __restrict third = counts.third;
  const std::uint16_t* __restrict fourth = counts.fourth;
  const float off = steps.off;
  const float on = steps.on;
  for (std::size_t i = 0; i < pixels; ++i) {
    const float whole =
        off * static_cast<float>(all[2 * i]) + on * static_cast<float>(all[2 * i + 1]);
    const float to_late =
        off * static_cast<float>(third[2 * i]) + on * static_cast<float>(third[2 * i + 1]);
    const float from_late =
        off * static_cast<float>(fourth[2 * i]) + on * static_cast<float>(fourth[2 * i + 1]);
    late[i] = to_late;
    end[i] = to_late + from_late;
    start[i] = end[i] - whole;
  }
}

FAST_EDI_VECTOR_CLONES
void subtract(const float* __restrict by, std::size_t count, float* __restrict values) {
  for (std::size_t i = 0; i < count; ++i) {
    values[i] -= by[i];
  }
}

}  // namespace

void EventChanges::measure(const PixelEventLists& lists, const ExposureInterval& window,
                           const std::uint16_t* counts, const LaterQuarters& quarters,
                           const LatentGains::Model& model) {
  const std::size_t pixels = lists.size().pixelCount();
  for (std::vector<float>& change : change_) {
    change.resize(pixels);
  }
  auto& [start, late, end] = change_;
  sumSteps({counts, quarters.third().data(), quarters.fourth().data()}, Steps(model.thresholds),
           pixels, start.data(), late.data(), end.data());
  const std::uint64_t events = lists.lowerBound(window.end_ns) - lists.lowerBound(window.start_ns);
  if (events >= kManyEvents * pixels || model.level.isStaircase()) {
    return;
  }
  const RampRises rises(model.level, model.thresholds);
  const auto add_begun = [&](std::int64_t t_ns, std::vector<float>& sum) {
    visitOpenRamps(lists, t_ns, window.end_ns, model.level, [&](const OpenRamp& ramp) {
      sum[ramp.pixel] += static_cast<float>(rises.rise[ramp.on] * ramp.done);
    });
  };
  middle_.assign(pixels, 0.0F);
  add_begun(window.at(ExposureInstant::kMid), middle_);
  for (std::vector<float>& change : change_) {
    subtract(middle_.data(), pixels, change.data());
  }
  add_begun(window.start_ns, start);
  add_begun(LaterQuarters::lateInstant(window), late);
}

std::size_t EventChanges::memoryBytes() const {
  std::size_t floats = middle_.capacity();
  for (const std::vector<float>& change : change_) {
    floats += change.capacity();
  }
  return floats * sizeof(float);
}

}  // namespace fast_edi
