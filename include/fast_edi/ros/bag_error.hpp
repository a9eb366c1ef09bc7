/// \file
#pragma once

#include <stdexcept>

namespace fast_edi {

/// A bag that cannot be read or written at all. what() names the file and the reason.
class BagError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace fast_edi
