/// \file
/// A connection to a server, over TCP or a local (Unix) socket.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>

#include "stream/interrupt.hpp"
#include "stream/stream_endpoint.hpp"

namespace fast_edi {

/// An Interrupt ends each wait at once; only the answer of a resolver, for an address that is a
/// name, is waited for.
class ClientSocket {
 public:
  /// Connects.
  /// \param interrupt must outlive this
  /// \throws StreamError, also when interrupted
  ClientSocket(const StreamEndpoint& endpoint, std::chrono::milliseconds timeout,
               const Interrupt& interrupt);
  ~ClientSocket();
  ClientSocket(const ClientSocket&) = delete;
  ClientSocket& operator=(const ClientSocket&) = delete;

  enum class Reading { kBytes, kEnd, kTimeout, kInterrupted };
  /// Reads what has come, at least one byte and at most \p size.
  /// \param count set to the number of bytes, 0 unless kBytes
  /// \throws StreamError when the connection broke
  Reading read(std::uint8_t* data, std::size_t size, std::chrono::milliseconds timeout,
               std::size_t& count);
  /// Writes as many of a few bytes as the connection takes at once; none when it is broken.
  void writeSome(const std::uint8_t* data, std::size_t size);

 private:
  void connectTcp(const StreamEndpoint& endpoint, std::chrono::milliseconds timeout);
  void connectLocal(const StreamEndpoint& endpoint, std::chrono::milliseconds timeout);
  void finishConnecting(int result, std::chrono::milliseconds timeout);
  void close();

  const Interrupt& interrupt_;
  int descriptor_ = -1;
};

}  // namespace fast_edi
