/// \file
/// Counts calls of the global operator new, for tests that promise "no allocation", and what they
/// allocate, for tests of what memory is said to be in use.
#pragma once

#include <cstdint>

namespace fast_edi::testing {

/// Calls of any form of operator new in this process so far. A program that calls this gets
/// replaced global operators, which count and then use malloc.
std::uint64_t allocationCount();

/// Bytes that are allocated just now by any form of operator new, rounded up as malloc does.
std::int64_t allocatedBytes();

}  // namespace fast_edi::testing
