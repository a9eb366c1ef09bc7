#include "fast_edi/base/deblur_counters.hpp"

#include <cstdlib>
#include <numeric>

#include "fast_edi/base/types.hpp"

namespace fast_edi {

const char* toString(PassReason reason) {
  switch (reason) {
    case PassReason::kPassthroughParameter:
      return "passthrough is set";
    case PassReason::kUnsupportedEncoding:
      return "encoding not supported";
    case PassReason::kSizeMismatch:
      return "size differs from the event sensor";
    case PassReason::kExposureUnknown:
      return "exposure unknown";
    case PassReason::kNoEventStream:
      return "no event stream yet";
    case PassReason::kEventsMissing:
      return "events missing in the exposure";
    case PassReason::kClocksDiffer:
      return "clocks differ";
    case PassReason::kTooManyWaiting:
      return "too many frames waiting";
  }
  return "unknown reason";
}

std::string toString(const ClockPair& clocks) {
  // Integers, so that no digit is lost and no locale puts in a comma.
  const auto seconds = [](std::int64_t t_ns) {
    const std::int64_t ms = t_ns / kNanosecondsPerMillisecond;
    const std::string fraction = std::to_string(1000 + std::abs(ms % 1000)).substr(1);
    return std::string(ms < 0 ? "-" : "") + std::to_string(std::abs(ms / 1000)) + "." + fraction +
           " s";
  };
  return "the last such frame is stamped " + seconds(clocks.frame_ns) + ", the newest event " +
         seconds(clocks.events_ns);
}

std::uint64_t DeblurCounters::framesPassed() const {
  return std::accumulate(frames_passed.begin(), frames_passed.end(), std::uint64_t{0});
}

}  // namespace fast_edi
