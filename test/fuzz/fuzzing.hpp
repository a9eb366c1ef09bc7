/// \file
/// What the fuzzers share. Each is one libFuzzer program: LLVMFuzzerTestOneInput() gets the bytes
/// of one input, and every crash, sanitizer report, exception that leaves it, or call of require()
/// that fails is a finding.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <string>

namespace fast_edi::fuzzing {

/// Ends the program, which is a finding, unless \p fault is empty.
inline void requireNoFault(const std::string& fault) {
  if (!fault.empty()) {
    std::fprintf(stderr, "broken promise: %s\n", fault.c_str());
    std::abort();
  }
}

inline void require(bool condition, const char* promise) {
  requireNoFault(condition ? "" : promise);
}

}  // namespace fast_edi::fuzzing
