#include "evaluation/frames_by_stamp.hpp"

#include "fast_edi/base/types.hpp"

namespace fast_edi {
namespace {

constexpr std::int64_t kToleranceNs = kNanosecondsPerMicrosecond;

}  // namespace

FramesByStamp::const_iterator frameAt(const FramesByStamp& frames, std::int64_t stamp_ns) {
  const auto after = frames.lower_bound(stamp_ns - kToleranceNs);
  return after != frames.end() && after->first <= stamp_ns + kToleranceNs ? after : frames.end();
}

}  // namespace fast_edi
