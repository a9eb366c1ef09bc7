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

FAST_EDI_VECTOR_CLONES
void halveRow(const float* __restrict upper, const float* __restrict lower, std::size_t width,
              float* __restrict out) {
  constexpr float kQuarter = 0.25F;
  for (std::size_t x = 0; x < width; ++x) {
    out[x] = kQuarter * ((upper[2 * x] + upper[2 * x + 1]) + (lower[2 * x] + lower[2 * x + 1]));
  }
}

void halve(const std::vector<float>& plane, SensorSize size, std::vector<float>& halved) {
  const auto width = static_cast<std::size_t>(size.width);
  const std::size_t half_width = width / 2;
  const auto half_height = static_cast<std::size_t>(size.height / 2);
  halved.resize(half_width * half_height);
  for (std::size_t y = 0; y < half_height; ++y) {
    const float* upper = plane.data() + 2 * y * width;
    halveRow(upper, upper + width, half_width, halved.data() + y * half_width);
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
  if (events < kManyEvents * pixels && !model.level.isStaircase()) {
    addBegunSteps(lists, window, model);
  }
  for (std::size_t k = 0; k < kInstants; ++k) {
    halve(change_[k], lists.size(), halved_[k]);
  }
}

void EventChanges::addBegunSteps(const PixelEventLists& lists, const ExposureInterval& window,
                                 const LatentGains::Model& model) {
  const RampRises rises(model.level, model.thresholds);
  const auto add_begun = [&](std::int64_t t_ns, std::vector<float>& sum) {
    visitOpenRamps(lists, t_ns, window.end_ns, model.level, [&](const OpenRamp& ramp) {
      sum[ramp.pixel] += static_cast<float>(rises.rise[ramp.on] * ramp.done);
    });
  };
  auto& [start, late, end] = change_;
  middle_.assign(end.size(), 0.0F);
  add_begun(window.at(ExposureInstant::kMid), middle_);
  for (std::vector<float>& change : change_) {
    subtract(middle_.data(), middle_.size(), change.data());
  }
  add_begun(window.start_ns, start);
  add_begun(LaterQuarters::lateInstant(window), late);
}

std::size_t EventChanges::memoryBytes() const {
  std::size_t floats = middle_.capacity();
  for (std::size_t k = 0; k < kInstants; ++k) {
    floats += change_[k].capacity() + halved_[k].capacity();
  }
  return floats * sizeof(float);
}

}  // namespace fast_edi
