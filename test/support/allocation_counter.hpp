/// \file
/// Counts calls of the global operator new, for tests that promise "no allocation".
#pragma once

#include <cstdint>

namespace fast_edi::testing {

/// Calls of any form of operator new in this process so far. A program that calls this gets
/// replaced global operators, which count and then use malloc.
std::uint64_t allocationCount();

}  // namespace fast_edi::testing
