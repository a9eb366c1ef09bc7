/// \file
/// The input of a fuzzer as a file.
#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <string>

#include "fuzz/fuzzing.hpp"

namespace fast_edi::fuzzing {

/// A regular file in memory, which is faster than one on a disk.
class MemoryFile {
 public:
  MemoryFile() : descriptor_(::memfd_create("input", 0)) {
    require(descriptor_ >= 0, "there is memory for a file");
  }
  std::string path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }
  void fill(const std::uint8_t* data, std::size_t size) const {
    require(::ftruncate(descriptor_, 0) == 0 &&
                ::pwrite(descriptor_, data, size, 0) == static_cast<ssize_t>(size),
            "a file in memory can be written");
  }

 private:
  int descriptor_;
};

}  // namespace fast_edi::fuzzing
