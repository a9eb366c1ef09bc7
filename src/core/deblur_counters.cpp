#include "fast_edi/core/deblur_counters.hpp"

#include <numeric>

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
  }
  return "unknown reason";
}

std::uint64_t DeblurCounters::framesPassed() const {
  return std::accumulate(frames_passed.begin(), frames_passed.end(), std::uint64_t{0});
}

}  // namespace fast_edi
