#include "bags/nothing_deblurred.hpp"

#include <algorithm>
#include <cstddef>
#include <iterator>

namespace fast_edi {
namespace {

/// What cfg/symptoms.md says of it, in short.
std::string adviceFor(PassReason reason, const ClockPair& clocks) {
  switch (reason) {
    case PassReason::kPassthroughParameter:
      return "passthrough:=false deblurs";
    case PassReason::kUnsupportedEncoding:
      return "expected mono, rgb, bgr, rgba, bgra or raw Bayer of 8 or 16 bits (little-endian)";
    case PassReason::kSizeMismatch:
      return "name the topics of one camera by --image and --events, or turn the events by "
             "event_orientation; cropped or scaled frames cannot be used";
    case PassReason::kExposureUnknown:
      return "give exposure_time_us:=MICROSECONDS, of which validate_bag proposes a value, or name "
             "the topic of the exposure times by --exposure";
    case PassReason::kNoEventStream:
      return "name the topic of the events by --events";
    case PassReason::kEventsMissing:
      return "events were lost, or end before the frames begin: validate_bag says where";
    case PassReason::kClocksDiffer:
      return toString(clocks) + "; validate_bag proposes a time_offset_us";
    case PassReason::kTooManyWaiting:
      return "look at the stamps of events and exposures: validate_bag";
  }
  return {};
}

}  // namespace

std::string nothingDeblurred(const DeblurCounters& counters, const ClockPair& clocks) {
  const auto& passed = counters.frames_passed;
  if (counters.frames_deblurred > 0 ||
      passed[static_cast<std::size_t>(PassReason::kPassthroughParameter)] > 0) {
    return {};
  }
  const std::string beginning = "no frame was deblurred: ";
  if (counters.frames_in == 0) {
    return beginning + "there are none on the topic of the frames; --image names another one";
  }
  const auto most = std::max_element(passed.begin(), passed.end());
  if (*most == 0) {
    return beginning + "the stamps of the " + std::to_string(counters.frames_in) +
           " frames do not increase: validate_bag says where";
  }
  const auto reason = static_cast<PassReason>(std::distance(passed.begin(), most));
  return beginning + std::to_string(counters.framesPassed()) + " of " +
         std::to_string(counters.frames_in) + " passed through unchanged, " +
         std::to_string(*most) + " for this reason: " + toString(reason) + " (" +
         adviceFor(reason, clocks) + ")";
}

}  // namespace fast_edi
