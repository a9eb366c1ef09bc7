#include "node/latency_record.hpp"

#include <algorithm>
#include <cmath>

namespace fast_edi {

void LatencyRecord::add(std::int64_t duration_ns) {
  if (durations_ns_.size() < kCapacity) {
    durations_ns_.push_back(duration_ns);
    return;
  }
  durations_ns_[next_] = duration_ns;
  next_ = (next_ + 1) % kCapacity;
}

std::int64_t LatencyRecord::percentile(double fraction) const {
  if (durations_ns_.empty()) {
    return 0;
  }
  std::vector<std::int64_t> sorted = durations_ns_;
  const auto rank =
      static_cast<std::size_t>(std::ceil(fraction * static_cast<double>(sorted.size())));
  const auto nth = sorted.begin() + static_cast<std::ptrdiff_t>(std::max<std::size_t>(rank, 1) - 1);
  std::nth_element(sorted.begin(), nth, sorted.end());
  return *nth;
}

}  // namespace fast_edi
