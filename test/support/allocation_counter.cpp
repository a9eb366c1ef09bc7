#include "support/allocation_counter.hpp"

#include <malloc.h>

#include <atomic>
#include <cstdlib>
#include <new>

namespace {

std::atomic<std::uint64_t> allocation_count{0};
std::atomic<std::int64_t> allocated_bytes{0};

void* countedAllocation(std::size_t bytes, std::size_t alignment) {
  ++allocation_count;
  void* memory = nullptr;
  if (posix_memalign(&memory, alignment, bytes) != 0) throw std::bad_alloc();
  allocated_bytes += static_cast<std::int64_t>(malloc_usable_size(memory));
  return memory;
}

void countedRelease(void* memory) {
  allocated_bytes -= static_cast<std::int64_t>(malloc_usable_size(memory));
  std::free(memory);
}

}  // namespace

// The array forms of the standard library end in these; so do the nothrow forms, but not under
// AddressSanitizer, which would then see memory of its own freed by us.
void* operator new(std::size_t bytes) {
  return countedAllocation(bytes, __STDCPP_DEFAULT_NEW_ALIGNMENT__);
}
void* operator new(std::size_t bytes, std::align_val_t alignment) {
  return countedAllocation(bytes, static_cast<std::size_t>(alignment));
}
void* operator new(std::size_t bytes, const std::nothrow_t&) noexcept {
  try {
    return operator new(bytes);
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
}
void* operator new(std::size_t bytes, std::align_val_t alignment, const std::nothrow_t&) noexcept {
  try {
    return operator new(bytes, alignment);
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
}
void operator delete(void* memory) noexcept {
  countedRelease(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  countedRelease(memory);
}
void operator delete(void* memory, std::align_val_t) noexcept {
  countedRelease(memory);
}
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
  countedRelease(memory);
}

namespace fast_edi::testing {

std::uint64_t allocationCount() {
  return allocation_count;
}

std::int64_t allocatedBytes() {
  return allocated_bytes;
}

}  // namespace fast_edi::testing
