/// \file
/// One stream of DV, received for as long as this lives: connects, reads, decodes, and connects
/// again whenever the connection ends.
///
/// There is a thread for each stream, since decompressing takes most of the time, and one that
/// waits for a name's address must not hold up the others. What is read is handed on before more is
/// read: there is no queue, and a server that sends more than can be taken has to wait or to drop.
#pragma once

#include <chrono>
#include <cstdint>
#include <mutex>
#include <string>
#include <thread>

#include "fast_edi/recording/recording.hpp"
#include "stream/interrupt.hpp"
#include "stream/packet_framing.hpp"
#include "stream/stream_decoder.hpp"
#include "stream/stream_endpoint.hpp"

namespace fast_edi {

class ClientSocket;

/// Where items go. Called from the thread of a StreamClient.
class StreamSink {
 public:
  StreamSink() = default;
  virtual ~StreamSink() = default;
  StreamSink(const StreamSink&) = delete;
  StreamSink& operator=(const StreamSink&) = delete;

  /// A connection was made. What was sent since the last one ended is lost.
  virtual void begin(const RecordedStream& stream) = 0;
  /// The next item of that stream.
  virtual void add(const RecordingItem& item) = 0;
};

struct StreamSettings {
  StreamEndpoint endpoint;
  StreamKind kind = StreamKind::kEvents;  ///< what is expected there
  /// Silence that ends a connection, or an attempt at one. Triggers may be silent for ever between
  /// their packets.
  std::chrono::milliseconds stall_timeout{2000};
  /// Longest wait between two attempts; it doubles up to this.
  std::chrono::milliseconds max_retry{500};
};

/// Counts are totals since construction.
struct StreamStatus {
  bool connected = false;      ///< and the header was accepted
  std::string fault;           ///< why the last attempt or connection ended; empty if none did
  std::string cut;             ///< why the last connection ended
  std::string damage;          ///< the last that was found
  RecordedStream stream;       ///< of the last connection
  std::uint64_t attempts = 0;  ///< to connect
  std::uint64_t connections = 0;
  std::uint64_t cuts = 0;     ///< connections that ended, for whatever reason
  std::uint64_t stalls = 0;   ///< those of them that ended by silence
  std::uint64_t damaged = 0;  ///< places that could not be read
  std::uint64_t packets = 0;
  std::uint64_t bytes = 0;  ///< of packets, as sent
  std::uint64_t items = 0;  ///< events, frames, samples or triggers that were handed on
};

class StreamClient {
 public:
  /// \param sink must outlive this
  StreamClient(StreamSettings settings, StreamSink& sink);
  /// Waits for an item that is just being handed on.
  ~StreamClient();
  StreamClient(const StreamClient&) = delete;
  StreamClient& operator=(const StreamClient&) = delete;

  const StreamSettings& settings() const { return settings_; }
  StreamStatus status() const;

 private:
  void run();
  /// One connection from its beginning to its end.
  /// \throws std::exception with the reason of the end, unless it was interrupted
  void converse();
  PacketFraming::Unit readUnit(ClientSocket& socket, PacketFraming& framing);
  void checkForTls(ClientSocket& socket, PacketFraming& framing);
  void handOn(StreamDecoder& decoder, const PacketFraming& framing);
  void noteConnection(const RecordedStream& stream);
  void noteEnd(const char* fault, bool stalled);
  std::uint64_t packets() const;

  const StreamSettings settings_;
  StreamSink& sink_;
  Interrupt interrupt_;
  mutable std::mutex mutex_;
  StreamStatus status_;
  std::thread thread_;
};

}  // namespace fast_edi
