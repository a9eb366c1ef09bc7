#include "reblur/event_changes.hpp"

#include "integral/level_ramps.hpp"

namespace fast_edi {
namespace {

void addSteps(const PixelEventLists& lists, std::int64_t from_ns, std::int64_t to_ns,
              const ContrastThresholds& thresholds, std::vector<float>& sum) {
  const float steps[2] = {static_cast<float>(thresholds.step(false)),
                          static_cast<float>(thresholds.step(true))};
  const std::uint64_t end = lists.lowerBound(to_ns);
  for (std::uint64_t next = lists.lowerBound(from_ns); next < end;) {
    const PackedEventSpan span = lists.span(next, end);
    for (std::size_t i = 0; i < span.count; ++i) {
      sum[span.data[i].code >> 1] += steps[span.data[i].code & 1u];
    }
    next += span.count;
  }
}

}  // namespace

void EventChanges::measure(const PixelEventLists& lists, const ExposureInterval& window,
                           const LatentGains::Model& model) {
  const std::size_t pixels = lists.size().pixelCount();
  const std::int64_t middle_ns = window.at(ExposureInstant::kMid);
  const RampRises rises(model.level, model.thresholds);
  const auto keep = [&](std::int64_t t_ns, std::vector<float>& kept) {
    kept = sum_;
    visitOpenRamps(lists, t_ns, window.end_ns, model.level, [&](const OpenRamp& ramp) {
      kept[ramp.pixel] += static_cast<float>(rises.rise[ramp.on] * ramp.done);
    });
  };
  sum_.assign(pixels, 0.0F);
  const std::int64_t quarter = window.length() / 4;
  const std::array<std::int64_t, kInstants> instants = {window.start_ns, window.start_ns + quarter,
                                                        window.end_ns - quarter, window.end_ns};
  keep(instants[0], change_[0]);
  addSteps(lists, instants[0], instants[1], model.thresholds, sum_);
  keep(instants[1], change_[1]);
  addSteps(lists, instants[1], middle_ns, model.thresholds, sum_);
  keep(middle_ns, middle_);
  addSteps(lists, middle_ns, instants[2], model.thresholds, sum_);
  keep(instants[2], change_[2]);
  addSteps(lists, instants[2], instants[3], model.thresholds, sum_);
  keep(instants[3], change_[3]);
  for (std::vector<float>& change : change_) {
    for (std::size_t i = 0; i < pixels; ++i) {
      change[i] -= middle_[i];
    }
  }
}

std::size_t EventChanges::memoryBytes() const {
  std::size_t floats = sum_.capacity() + middle_.capacity();
  for (const std::vector<float>& change : change_) {
    floats += change.capacity();
  }
  return floats * sizeof(float);
}

}  // namespace fast_edi
