/// \file
#pragma once

#include <stdexcept>

namespace fast_edi {

/// A recording that cannot be read or written at all. what() names the file and the reason.
class RecordingError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace fast_edi
