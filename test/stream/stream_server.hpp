/// \file
/// A server that does what a test's script says, also what no server of DV would do.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <string>
#include <thread>

#include "stream/interrupt.hpp"
#include "stream/stream_endpoint.hpp"

namespace fast_edi::testing {

/// The other end of one connection.
class StreamPeer {
 public:
  /// \param number of connections before this one
  StreamPeer(int descriptor, int number, const Interrupt& interrupt)
      : descriptor_(descriptor), number_(number), interrupt_(interrupt) {}

  int number() const { return number_; }
  /// Sends all of it, as fast as the client takes it. \return false when it left or the test ends
  bool send(const std::string& bytes);
  /// The same in pieces that arrive one by one.
  bool sendInPieces(const std::string& bytes, std::size_t piece_bytes);
  /// Waits until the client leaves or the test ends.
  void waitForEnd();
  /// What the client has sent, once it sends something. Empty when it left or the test ends.
  std::string receive();
  /// Waits. \return false when the test ends
  bool pause(std::chrono::milliseconds duration) { return !interrupt_.waitFor(duration); }

 private:
  const int descriptor_;
  const int number_;
  const Interrupt& interrupt_;
};

/// Serves one connection after the other in a thread of its own; each ends with its script.
class StreamServer {
 public:
  using Script = std::function<void(StreamPeer& peer)>;

  /// On a free TCP port, or on the local socket \p path if that is not empty.
  /// \param port 0: a free one
  explicit StreamServer(Script script, const std::string& path = {}, std::uint16_t port = 0);
  /// Ends the script at its next call of its peer.
  ~StreamServer();
  StreamServer(const StreamServer&) = delete;
  StreamServer& operator=(const StreamServer&) = delete;

  const StreamEndpoint& endpoint() const { return endpoint_; }
  /// That were accepted so far.
  int connections() const { return connections_; }

 private:
  void serve();

  const Script script_;
  StreamEndpoint endpoint_;
  int descriptor_ = -1;
  std::atomic<int> connections_{0};
  Interrupt interrupt_;
  std::thread thread_;
};

}  // namespace fast_edi::testing
