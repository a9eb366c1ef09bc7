#include "stream/stream_client.hpp"

#include <algorithm>
#include <exception>
#include <new>
#include <utility>
#include <vector>

#include "fast_edi/base/number_text.hpp"
#include "stream/client_socket.hpp"
#include "stream/foreign_protocol.hpp"
#include "stream/stream_error.hpp"

namespace fast_edi {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kFirstRetry(20);
/// For the answer to kTlsProbe.
constexpr milliseconds kProbeTimeout(300);

/// Events, frames, samples or triggers in an item.
std::uint64_t countOf(const RecordingItem& item) {
  const auto* events = std::get_if<RecordedEvents>(&item.content);
  return events != nullptr ? events->count : 1;
}

}  // namespace

StreamClient::StreamClient(StreamSettings settings, StreamSink& sink)
    : settings_(std::move(settings)), sink_(sink), thread_([this] { run(); }) {}

StreamClient::~StreamClient() {
  interrupt_.raise();
  thread_.join();
}

StreamStatus StreamClient::status() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return status_;
}

std::uint64_t StreamClient::packets() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return status_.packets;
}

/// Nothing in it throws but what is caught: an exception would end the process.
void StreamClient::run() {
  milliseconds delay(0);
  while (!interrupt_.waitFor(delay)) {
    const std::uint64_t packets_before = packets();
    try {
      converse();
    } catch (const StreamStall& stall) {
      noteEnd(stall.what(), true);
    } catch (const std::exception& error) {
      noteEnd(error.what(), false);
    }
    delay = packets() > packets_before || delay == milliseconds(0)
                ? std::min(kFirstRetry, settings_.max_retry)
                : std::min(2 * delay, settings_.max_retry);
  }
}

void StreamClient::converse() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ++status_.attempts;
  }
  ClientSocket connection(settings_.endpoint, settings_.stall_timeout, interrupt_);
  PacketFraming framing;
  if (readUnit(connection, framing) == PacketFraming::Unit::kNone) {
    return;
  }
  StreamDecoder decoder(framing.content(), settings_.kind);
  noteConnection(decoder.stream());
  sink_.begin(decoder.stream());
  while (readUnit(connection, framing) != PacketFraming::Unit::kNone) {
    handOn(decoder, framing);
  }
}

/// \return kNone when interrupted
PacketFraming::Unit StreamClient::readUnit(ClientSocket& socket, PacketFraming& framing) {
  const bool header = !framing.hasHeader();
  for (;;) {
    const PacketFraming::Room room = framing.room();
    std::size_t count = 0;
    switch (socket.read(room.data, room.size, settings_.stall_timeout, count)) {
      case ClientSocket::Reading::kInterrupted:
        return PacketFraming::Unit::kNone;
      case ClientSocket::Reading::kEnd:
        framing.checkHeaderStart();
        throw StreamError(std::string("the server ended the connection") +
                          (header                   ? " before its header was complete"
                           : framing.isWithinUnit() ? " in the middle of a packet"
                                                    : ""));
      case ClientSocket::Reading::kTimeout:
        if (!header && !framing.isWithinUnit() && settings_.kind == StreamKind::kTriggers) {
          continue;
        }
        if (header) {
          checkForTls(socket, framing);
        }
        throw StreamStall(
            "nothing came for " +
            fixedText(std::chrono::duration<double>(settings_.stall_timeout).count(), 1) + " s" +
            (header                   ? ", expected a header"
             : framing.isWithinUnit() ? " in the middle of a packet"
                                      : ""));
      case ClientSocket::Reading::kBytes:
        break;
    }
    const PacketFraming::Unit unit = framing.add(count);
    if (unit != PacketFraming::Unit::kNone) {
      return unit;
    }
  }
}

/// \throws StreamError when the server, which said nothing so far, speaks TLS
void StreamClient::checkForTls(ClientSocket& socket, PacketFraming& framing) {
  socket.writeSome(kTlsProbe.data(), kTlsProbe.size());
  const PacketFraming::Room room = framing.room();
  std::size_t count = 0;
  if (socket.read(room.data, room.size, kProbeTimeout, count) == ClientSocket::Reading::kBytes) {
    framing.add(count);
    framing.checkHeaderStart();
  }
}

void StreamClient::handOn(StreamDecoder& decoder, const PacketFraming& framing) {
  const FlatBytes content = framing.content();
  decoder.open(framing.stream(), content);
  std::uint64_t items = 0;
  RecordingItem item;
  while (decoder.next(item)) {
    sink_.add(item);
    items += countOf(item);
  }
  const std::vector<RecordingDamage> damage = decoder.takeDamage();
  const std::lock_guard<std::mutex> lock(mutex_);
  ++status_.packets;
  status_.bytes += content.size;
  status_.items += items;
  status_.damaged += damage.size();
  if (!damage.empty()) {
    status_.damage = "packet " + std::to_string(damage.back().offset) + ": " + damage.back().what;
  }
}

void StreamClient::noteConnection(const RecordedStream& stream) {
  const std::lock_guard<std::mutex> lock(mutex_);
  status_.connected = true;
  ++status_.connections;
  status_.stream = stream;
}

void StreamClient::noteEnd(const char* fault, bool stalled) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const bool cut = std::exchange(status_.connected, false);
  status_.cuts += cut ? 1 : 0;
  status_.stalls += cut && stalled ? 1 : 0;
  try {
    status_.fault = fault;
    if (cut) {
      status_.cut = fault;
    }
  } catch (const std::bad_alloc&) {
    status_.fault.clear();  // no memory for the reason: the counts have to do
  }
}

}  // namespace fast_edi
