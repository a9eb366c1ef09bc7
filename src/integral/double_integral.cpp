#include "fast_edi/integral/double_integral.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "fast_edi/base/number_text.hpp"
#include "fast_edi/integral/gain_limits.hpp"
#include "integral/gain_kernel.hpp"
#include "integral/level_ramps.hpp"
#include "integral/running_integral.hpp"

namespace fast_edi {
namespace {

void requirePositive(const char* name, double threshold) {
  if (!std::isfinite(threshold) || threshold <= 0.0) {
    throw std::invalid_argument(std::string(name) + " is " + numberText(threshold) +
                                ", expected a finite number > 0");
  }
}

}  // namespace

struct DoubleIntegral::State {
  explicit State(std::size_t pixels) : before(pixels), after(pixels) {}

  EventFactors factors{};
  RunningIntegral before;  ///< over [start, reference)
  RunningIntegral after;   ///< over [reference, end)
};

DoubleIntegral::DoubleIntegral(SensorSize size, ContrastThresholds thresholds, Weighting weighting,
                               LevelModel level)
    : size_(size),
      weighting_(weighting),
      level_(weighting == Weighting::kTime ? level : LevelModel{}),
      state_(std::make_unique<State>(size.pixelCount())) {
  setThresholds(thresholds);
}

DoubleIntegral::~DoubleIntegral() = default;

void DoubleIntegral::setThresholds(ContrastThresholds thresholds) {
  requirePositive("ON contrast threshold", thresholds.on);
  requirePositive("OFF contrast threshold", thresholds.off);
  thresholds_ = thresholds;
  for (const bool on : {false, true}) {
    state_->factors.multiplier[on] = std::exp(thresholds.step(on));
    state_->factors.one_minus[on] = -std::expm1(thresholds.step(on));
    state_->factors.excess[on] = LevelModel::excess(level_.fraction * thresholds.step(on)) *
                                 static_cast<double>(kIntervalTick_ns);
  }
  state_->factors.most_ticks = level_.isStaircase() ? std::uint16_t{0} : level_.mostTicks();
  reset();
}

std::size_t DoubleIntegral::memoryBytes() const {
  return state_->before.memoryBytes() + state_->after.memoryBytes();
}

void DoubleIntegral::reset() {
  state_->before.reset();
  state_->after.reset();
}

void DoubleIntegral::predictWindow(const ExposureInterval& window, std::int64_t reference_ns) {
  state_->before.predictInterval({window.start_ns, reference_ns});
  state_->after.predictInterval({reference_ns, window.end_ns});
}

void DoubleIntegral::accumulate(const PixelEventLists& lists) {
  state_->before.accumulate(lists, state_->factors, weighting_);
  state_->after.accumulate(lists, state_->factors, weighting_);
}

IntegrationReport DoubleIntegral::integrate(const PixelEventLists& lists,
                                            const ExposureInterval& window,
                                            std::int64_t reference_ns, float* gain) {
  const RunningIntegral::Result before =
      state_->before.integrate(lists, {window.start_ns, reference_ns}, state_->factors, weighting_);
  const RunningIntegral::Result after =
      state_->after.integrate(lists, {reference_ns, window.end_ns}, state_->factors, weighting_);

  IntegrationReport report;
  report.kind = before.predicted && after.predicted ? IntegrationKind::kPredicted
                                                    : IntegrationKind::kNotPredicted;
  report.events = lists.lowerBound(window.end_ns) - lists.lowerBound(window.start_ns);
  report.walked = before.walked + after.walked;
  if (before.clock.length() + after.clock.length() > 0.0) {
    cutRampsAtStart(lists, window, reference_ns);
    takeGains({state_->before.sums(), before.clock}, {state_->after.sums(), after.clock},
              size_.pixelCount(), gain);
    addRampsAtReference(lists, window, reference_ns, gain);
    report.out_of_range = replaceOutOfRange(size_.pixelCount(), gain);
  } else {  // counter weighting, no event
    std::fill(gain, gain + size_.pixelCount(), 1.0F);
  }
  state_->before.markSumsTaken();
  state_->after.markSumsTaken();
  return report;
}

/// The sums hold whole ramps. What of them lies before the window does not belong to it. No event
/// of the pixel lies between, so its value there is that at the start and at the reference alike.
void DoubleIntegral::cutRampsAtStart(const PixelEventLists& lists, const ExposureInterval& window,
                                     std::int64_t reference_ns) {
  const RampRises rises(level_, thresholds_);
  PixelSums* const before = state_->before.sums();
  PixelSums* const after = state_->after.sums();
  visitOpenRamps(lists, window.start_ns, window.end_ns, level_, [&](const OpenRamp& ramp) {
    PixelSums* const sums = ramp.event_ns < reference_ns ? before : after;
    sums[ramp.pixel].sum -= rises.excess(ramp);
  });
}

/// From the level that the events before the reference time have left to that at it.
void DoubleIntegral::addRampsAtReference(const PixelEventLists& lists,
                                         const ExposureInterval& window, std::int64_t reference_ns,
                                         float* gain) const {
  const RampRises rises(level_, thresholds_);
  constexpr auto kMin = static_cast<float>(kMinGain);
  constexpr auto kMax = static_cast<float>(kMaxGain);
  visitOpenRamps(lists, reference_ns, window.end_ns, level_, [&](const OpenRamp& ramp) {
    float& value = gain[ramp.pixel];
    if (value > kMin && value < kMax) {  // neither out of range nor at a limit
      value = std::min(std::max(value * rises.value(ramp), kMin), kMax);
    }
  });
}

}  // namespace fast_edi
