/// \file
/// Percentiles of the most recent durations.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace fast_edi {

/// Keeps the last kCapacity durations; older ones are discarded.
class LatencyRecord {
 public:
  static constexpr std::size_t kCapacity = 1000;

  void add(std::int64_t duration_ns);

  /// The smallest kept duration that at least \p fraction of the kept ones do not exceed (nearest
  /// rank) [ns]; 0 when empty. \pre 0 < fraction <= 1
  std::int64_t percentile(double fraction) const;

 private:
  std::vector<std::int64_t> durations_ns_;
  std::size_t next_ = 0;  ///< the oldest entry, once full
};

}  // namespace fast_edi
