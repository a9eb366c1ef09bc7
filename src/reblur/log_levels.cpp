#include "reblur/log_levels.hpp"

#include <algorithm>

#include "base/fast_log.hpp"
#include "base/vector_clones.hpp"

namespace fast_edi {
namespace {

/// Added to levels, so that dark ones have a log that means something [DN].
constexpr float kDark_dn = 3.0F;

FAST_EDI_VECTOR_CLONES
void logOf(const float* __restrict level, std::size_t count, float offset, float* __restrict log) {
  for (std::size_t i = 0; i < count; ++i) {
    log[i] = fastLog(std::max(0.0F, level[i]) + offset);
  }
}

}  // namespace

void logLevels(const float* level, std::size_t count, float offset_dn, float* log) {
  logOf(level, count, offset_dn + kDark_dn, log);
}

}  // namespace fast_edi
