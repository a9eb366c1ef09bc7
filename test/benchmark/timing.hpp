/// \file
/// Time taking and percentiles for the benchmarks.
#pragma once

#include <time.h>

#include <algorithm>
#include <cstddef>
#include <vector>

#include "fast_edi/base/types.hpp"

namespace fast_edi::benchmarks {

/// Counts the processor time of this thread, so that other processes on the machine do not show.
/// On an idle machine it equals the elapsed time: nothing here waits for anything.
class Stopwatch {
 public:
  double seconds() const { return now() - start_; }

 private:
  static double now() {
    timespec time;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) +
           static_cast<double>(time.tv_nsec) / kNanosecondsPerSecond;
  }

  double start_ = now();
};

/// \pre values is not empty, 0 <= fraction <= 1
inline double percentile(std::vector<double> values, double fraction) {
  const auto rank = static_cast<std::size_t>(fraction * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(rank),
                   values.end());
  return values[rank];
}

}  // namespace fast_edi::benchmarks
