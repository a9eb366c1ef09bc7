#include "fast_edi/core/latent_gains.hpp"

#include <algorithm>
#include <cmath>

#include "fast_edi/core/double_integral.hpp"

namespace fast_edi {

void LatentGains::start(const float* gain, std::size_t pixel_count, std::int64_t t_ns,
                        ContrastThresholds thresholds) {
  gain_.assign(gain, gain + pixel_count);
  t_ns_ = t_ns;
  thresholds_ = thresholds;
}

std::uint64_t LatentGains::at(const PixelEventLists& lists, std::int64_t t_ns, float* gain) {
  // A product does not ask for order: back, too, events are walked from the oldest on.
  const double direction = t_ns < t_ns_ ? -1.0 : 1.0;
  const double factors[2] = {std::exp(direction * thresholds_.step(false)),
                             std::exp(direction * thresholds_.step(true))};
  const std::uint64_t begin = lists.lowerBound(std::min(t_ns, t_ns_));
  const std::uint64_t end = lists.lowerBound(std::max(t_ns, t_ns_));
  for (std::uint64_t next = begin; next < end;) {
    const PackedEventSpan span = lists.span(next, end);
    for (std::size_t i = 0; i < span.count; ++i) {
      const std::uint32_t code = span.data[i].code;
      gain_[code >> 1] *= factors[code & 1u];
    }
    next += span.count;
  }
  t_ns_ = t_ns;
  std::transform(gain_.begin(), gain_.end(), gain, [](double value) {
    return static_cast<float>(
        std::min(std::max(value, DoubleIntegral::kMinGain), DoubleIntegral::kMaxGain));
  });
  return end - begin;
}

}  // namespace fast_edi
