#include "stream/client_socket.hpp"

#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <memory>
#include <string>
#include <system_error>

#include "stream/stream_error.hpp"

namespace fast_edi {
namespace {

using std::chrono::milliseconds;

/// A peer that vanished without a word is noticed within half a minute, though nothing is sent.
constexpr int kKeepAliveIdle_s = 15;
constexpr int kKeepAliveInterval_s = 5;
constexpr int kKeepAliveProbes = 3;

std::string errorText(int error) {
  return std::generic_category().message(error);
}

using AddressList = std::unique_ptr<addrinfo, void (*)(addrinfo*)>;

/// \throws StreamError
AddressList resolve(const StreamEndpoint& endpoint) {
  addrinfo hints = {};
  hints.ai_family = AF_UNSPEC;
  hints.ai_socktype = SOCK_STREAM;
  hints.ai_flags = AI_NUMERICSERV;
  addrinfo* found = nullptr;
  const int result = ::getaddrinfo(endpoint.address.c_str(), std::to_string(endpoint.port).c_str(),
                                   &hints, &found);
  if (result != 0) {
    throw StreamError("no address is known for \"" + endpoint.address +
                      "\": " + ::gai_strerror(result));
  }
  return {found, ::freeaddrinfo};
}

void keepAlive(int descriptor) {
  const auto set = [descriptor](int level, int name, int value) {
    ::setsockopt(descriptor, level, name, &value, sizeof(value));  // without them it works, too
  };
  set(SOL_SOCKET, SO_KEEPALIVE, 1);
  set(IPPROTO_TCP, TCP_KEEPIDLE, kKeepAliveIdle_s);
  set(IPPROTO_TCP, TCP_KEEPINTVL, kKeepAliveInterval_s);
  set(IPPROTO_TCP, TCP_KEEPCNT, kKeepAliveProbes);
}

int openSocket(int family, int protocol) {
  const int descriptor = ::socket(family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, protocol);
  if (descriptor < 0) {
    throw StreamError("no socket: " + errorText(errno));
  }
  return descriptor;
}

}  // namespace

ClientSocket::ClientSocket(const StreamEndpoint& endpoint, milliseconds timeout,
                           const Interrupt& interrupt)
    : interrupt_(interrupt) {
  try {
    if (endpoint.socket_path.empty()) {
      connectTcp(endpoint, timeout);
    } else {
      connectLocal(endpoint, timeout);
    }
  } catch (...) {
    close();
    throw;
  }
}

ClientSocket::~ClientSocket() {
  close();
}

void ClientSocket::close() {
  if (descriptor_ >= 0) {
    ::close(descriptor_);
    descriptor_ = -1;
  }
}

void ClientSocket::connectTcp(const StreamEndpoint& endpoint, milliseconds timeout) {
  const AddressList addresses = resolve(endpoint);
  for (const addrinfo* address = addresses.get(); address != nullptr; address = address->ai_next) {
    try {
      descriptor_ = openSocket(address->ai_family, address->ai_protocol);
      keepAlive(descriptor_);
      finishConnecting(::connect(descriptor_, address->ai_addr, address->ai_addrlen), timeout);
      return;
    } catch (const StreamError&) {
      close();
      if (address->ai_next == nullptr || interrupt_.waitFor(milliseconds(0))) {
        throw;
      }
    }
  }
}

void ClientSocket::connectLocal(const StreamEndpoint& endpoint, milliseconds timeout) {
  sockaddr_un address = {};
  address.sun_family = AF_UNIX;
  if (endpoint.socket_path.size() >= sizeof(address.sun_path)) {
    throw StreamError("the path of the socket has " + std::to_string(endpoint.socket_path.size()) +
                      " characters, expected at most " +
                      std::to_string(sizeof(address.sun_path) - 1));
  }
  std::memcpy(address.sun_path, endpoint.socket_path.data(), endpoint.socket_path.size());
  descriptor_ = openSocket(AF_UNIX, 0);
  finishConnecting(
      ::connect(descriptor_, reinterpret_cast<const sockaddr*>(&address), sizeof(address)),
      timeout);
}

/// \param result of connect()
void ClientSocket::finishConnecting(int result, milliseconds timeout) {
  int error = result == 0 ? 0 : errno;
  if (error == EINPROGRESS) {
    switch (interrupt_.waitFor(descriptor_, POLLOUT, timeout)) {
      case Interrupt::Wait::kTimeout:
        throw StreamError("cannot connect: no answer within " + std::to_string(timeout.count()) +
                          " ms");
      case Interrupt::Wait::kInterrupted:
        throw StreamError("interrupted");
      case Interrupt::Wait::kReady:
        break;
    }
    socklen_t size = sizeof(error);
    if (::getsockopt(descriptor_, SOL_SOCKET, SO_ERROR, &error, &size) != 0) {
      error = errno;
    }
  }
  if (error != 0) {
    throw StreamError("cannot connect: " + errorText(error));
  }
}

ClientSocket::Reading ClientSocket::read(std::uint8_t* data, std::size_t size, milliseconds timeout,
                                         std::size_t& count) {
  count = 0;
  for (;;) {
    switch (interrupt_.waitFor(descriptor_, POLLIN, timeout)) {
      case Interrupt::Wait::kTimeout:
        return Reading::kTimeout;
      case Interrupt::Wait::kInterrupted:
        return Reading::kInterrupted;
      case Interrupt::Wait::kReady:
        break;
    }
    const ssize_t got = ::recv(descriptor_, data, size, 0);
    if (got > 0) {
      count = static_cast<std::size_t>(got);
      return Reading::kBytes;
    }
    if (got == 0) {
      return Reading::kEnd;
    }
    if (errno != EINTR && errno != EAGAIN && errno != EWOULDBLOCK) {
      throw StreamError("the connection broke: " + errorText(errno));
    }
  }
}

void ClientSocket::writeSome(const std::uint8_t* data, std::size_t size) {
  const ssize_t sent = ::send(descriptor_, data, size, MSG_NOSIGNAL);
  static_cast<void>(sent);
}

}  // namespace fast_edi
