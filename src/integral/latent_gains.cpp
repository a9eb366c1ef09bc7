#include "fast_edi/integral/latent_gains.hpp"

#include <algorithm>
#include <cmath>

#include "fast_edi/integral/double_integral.hpp"
#include "fast_edi/integral/gain_limits.hpp"
#include "integral/level_ramps.hpp"

namespace fast_edi {
namespace {

/// Within what DoubleIntegral::integrate() gives.
float limited(double gain) {
  return static_cast<float>(std::min(std::max(gain, kMinGain), kMaxGain));
}

}  // namespace

void LatentGains::start(const float* gain, const PixelEventLists& lists,
                        const LevelInstant& reference, const Model& model) {
  gain_.assign(gain, gain + lists.size().pixelCount());
  t_ns_ = reference.t_ns;
  model_ = model;
  const RampRises rises(model.level, model.thresholds);
  visitOpenRamps(lists, t_ns_, reference.known_until_ns, model.level, [&](const OpenRamp& ramp) {
    gain_[ramp.pixel] /= static_cast<double>(rises.value(ramp));
  });
}

std::uint64_t LatentGains::at(const PixelEventLists& lists, const LevelInstant& to, float* gain) {
  // A product does not ask for order: back, too, events are walked from the oldest on.
  const double direction = to.t_ns < t_ns_ ? -1.0 : 1.0;
  const double factors[2] = {std::exp(direction * model_.thresholds.step(false)),
                             std::exp(direction * model_.thresholds.step(true))};
  const std::uint64_t begin = lists.lowerBound(std::min(to.t_ns, t_ns_));
  const std::uint64_t end = lists.lowerBound(std::max(to.t_ns, t_ns_));
  for (std::uint64_t next = begin; next < end;) {
    const PackedEventSpan span = lists.span(next, end);
    for (std::size_t i = 0; i < span.count; ++i) {
      const std::uint32_t code = span.data[i].code;
      gain_[code >> 1] *= factors[code & 1u];
    }
    next += span.count;
  }
  t_ns_ = to.t_ns;
  std::transform(gain_.begin(), gain_.end(), gain, limited);
  const RampRises rises(model_.level, model_.thresholds);
  visitOpenRamps(lists, t_ns_, to.known_until_ns, model_.level, [&](const OpenRamp& ramp) {
    gain[ramp.pixel] = limited(gain_[ramp.pixel] * static_cast<double>(rises.value(ramp)));
  });
  return end - begin;
}

}  // namespace fast_edi
