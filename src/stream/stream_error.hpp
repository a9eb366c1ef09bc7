/// \file
#pragma once

#include <stdexcept>

namespace fast_edi {

/// A connection that cannot be made, or is of no use any more. what() says what was found and what
/// was expected.
class StreamError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Nothing came for too long.
class StreamStall : public StreamError {
 public:
  using StreamError::StreamError;
};

}  // namespace fast_edi
