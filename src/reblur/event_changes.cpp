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

void addSteps(const PixelEventLists& lists, std::int64_t from_ns, std::int64_t to_ns,
              const Steps& steps, std::vector<float>& sum) {
  const float by_polarity[2] = {steps.off, steps.on};
  const std::uint64_t end = lists.lowerBound(to_ns);
  for (std::uint64_t next = lists.lowerBound(from_ns); next < end;) {
    const PackedEventSpan span = lists.span(next, end);
    for (std::size_t i = 0; i < span.count; ++i) {
      sum[span.data[i].code >> 1] += by_polarity[span.data[i].code & 1u];
    }
    next += span.count;
  }
}

/// \param start steps begun at the start; written: change from the middle to the start
/// \param late steps from the middle to the later instant, and those begun there
/// \param end steps from the middle to the end
FAST_EDI_VECTOR_CLONES
void combine(const std::uint16_t* __restrict counts, const float* __restrict middle,
             const Steps& steps, std::size_t pixels, float* __restrict start,
             float* __restrict late, float* __restrict end) {
  const float off = steps.off;
  const float on = steps.on;
  for (std::size_t i = 0; i < pixels; ++i) {
    const float all =
        off * static_cast<float>(counts[2 * i]) + on * static_cast<float>(counts[2 * i + 1]);
    start[i] += end[i] - all - middle[i];
    late[i] -= middle[i];
    end[i] -= middle[i];
  }
}

}  // namespace

void EventChanges::measure(const PixelEventLists& lists, const ExposureInterval& window,
                           const std::uint16_t* counts, const LatentGains::Model& model) {
  const std::size_t pixels = lists.size().pixelCount();
  const std::int64_t middle_ns = window.at(ExposureInstant::kMid);
  const std::int64_t late_ns = window.end_ns - window.length() / 4;
  const Steps steps(model.thresholds);
  auto& [start, late, end] = change_;
  late.assign(pixels, 0.0F);
  addSteps(lists, middle_ns, late_ns, steps, late);
  end = late;
  addSteps(lists, late_ns, window.end_ns, steps, end);
  start.assign(pixels, 0.0F);
  middle_.assign(pixels, 0.0F);
  const std::uint64_t events = lists.lowerBound(window.end_ns) - lists.lowerBound(window.start_ns);
  if (events < kManyEvents * pixels) {
    const RampRises rises(model.level, model.thresholds);
    const auto add_begun = [&](std::int64_t t_ns, std::vector<float>& sum) {
      visitOpenRamps(lists, t_ns, window.end_ns, model.level, [&](const OpenRamp& ramp) {
        sum[ramp.pixel] += static_cast<float>(rises.rise[ramp.on] * ramp.done);
      });
    };
    add_begun(window.start_ns, start);
    add_begun(middle_ns, middle_);
    add_begun(late_ns, late);
  }
  combine(counts, middle_.data(), steps, pixels, start.data(), late.data(), end.data());
}

std::size_t EventChanges::memoryBytes() const {
  std::size_t floats = middle_.capacity();
  for (const std::vector<float>& change : change_) {
    floats += change.capacity();
  }
  return floats * sizeof(float);
}

}  // namespace fast_edi
