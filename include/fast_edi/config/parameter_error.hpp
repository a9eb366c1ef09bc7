/// \file
#pragma once

#include <stdexcept>

namespace fast_edi {

/// A configuration that cannot be used. what() names the key, what was found and what was expected,
/// one line for each fault.
class ParameterError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace fast_edi
