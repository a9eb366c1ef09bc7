/// \file
/// A buffer that is about to be written: std::vector without setting new elements to zero first,
/// which takes about as long as decompressing into them.
#pragma once

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace fast_edi {

/// Leaves elements that are made without a value as the memory was.
template <typename T>
class UnsetAllocator : public std::allocator<T> {
 public:
  UnsetAllocator() = default;
  template <typename U>
  UnsetAllocator(const UnsetAllocator<U>& /*other*/) {}  // NOLINT(google-explicit-constructor)
  template <typename U>
  struct rebind {                     // NOLINT(readability-identifier-naming): the standard's name
    using other = UnsetAllocator<U>;  // NOLINT(readability-identifier-naming)
  };

  template <typename U>
  void construct(U* place) {
    ::new (static_cast<void*>(place)) U;
  }
  template <typename U, typename... Arguments>
  void construct(U* place, Arguments&&... arguments) {
    ::new (static_cast<void*>(place)) U(std::forward<Arguments>(arguments)...);
  }
};

using RawBytes = std::vector<std::uint8_t, UnsetAllocator<std::uint8_t>>;

}  // namespace fast_edi
