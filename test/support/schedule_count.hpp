/// \file
/// How many random schedules a property test tries.
#pragma once

#include <cstdint>
#include <cstdlib>
#include <stdexcept>
#include <string>

namespace fast_edi::testing {

/// The value of the environment variable FAST_EDI_SCHEDULES, else \p usual; a third of that where a
/// sanitizer makes everything slow.
/// \throws std::invalid_argument when the variable is no positive number
inline std::uint64_t scheduleCount(std::uint64_t usual) {
  const char* text = std::getenv("FAST_EDI_SCHEDULES");
  if (text == nullptr) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    return usual / 3;
#else
    return usual;
#endif
  }
  const std::uint64_t count = std::stoull(text);
  if (count == 0) {
    throw std::invalid_argument("FAST_EDI_SCHEDULES is 0, expected 1 or more");
  }
  return count;
}

}  // namespace fast_edi::testing
