#include "stream/stream_server.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

namespace fast_edi::testing {
namespace {

constexpr std::chrono::milliseconds kLong(60'000);

void require(bool done, const char* what) {
  if (!done) {
    throw std::system_error(errno, std::generic_category(), what);
  }
}

}  // namespace

bool StreamPeer::send(const std::string& bytes) {
  std::size_t done = 0;
  while (done < bytes.size()) {
    if (interrupt_.waitFor(descriptor_, POLLOUT, kLong) != Interrupt::Wait::kReady) {
      return false;
    }
    const ssize_t sent =
        ::send(descriptor_, bytes.data() + done, bytes.size() - done, MSG_NOSIGNAL | MSG_DONTWAIT);
    if (sent < 0 && errno != EAGAIN) {
      return false;
    }
    done += static_cast<std::size_t>(std::max<ssize_t>(0, sent));
  }
  return true;
}

bool StreamPeer::sendInPieces(const std::string& bytes, std::size_t piece_bytes) {
  const int on = 1;  // no piece waits for the next one
  ::setsockopt(descriptor_, IPPROTO_TCP, TCP_NODELAY, &on, sizeof(on));
  for (std::size_t done = 0; done < bytes.size(); done += piece_bytes) {
    if (!send(bytes.substr(done, piece_bytes))) {
      return false;
    }
    std::this_thread::yield();
  }
  return true;
}

void StreamPeer::waitForEnd() {
  while (!receive().empty()) {
  }
}

std::string StreamPeer::receive() {
  std::array<char, 4096> bytes = {};
  if (interrupt_.waitFor(descriptor_, POLLIN, kLong) != Interrupt::Wait::kReady) {
    return {};
  }
  const ssize_t got = ::recv(descriptor_, bytes.data(), bytes.size(), 0);
  return {bytes.data(), static_cast<std::size_t>(std::max<ssize_t>(0, got))};
}

StreamServer::StreamServer(Script script, const std::string& path, std::uint16_t port)
    : script_(std::move(script)) {
  if (path.empty()) {
    sockaddr_in address = {};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    descriptor_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    const int on = 1;
    ::setsockopt(descriptor_, SOL_SOCKET, SO_REUSEADDR, &on, sizeof(on));
    require(::bind(descriptor_, reinterpret_cast<sockaddr*>(&address), sizeof(address)) == 0,
            "bind");
    socklen_t size = sizeof(address);
    require(::getsockname(descriptor_, reinterpret_cast<sockaddr*>(&address), &size) == 0,
            "getsockname");
    endpoint_.address = "127.0.0.1";
    endpoint_.port = ntohs(address.sin_port);
  } else {
    sockaddr_un address = {};
    address.sun_family = AF_UNIX;
    std::strncpy(address.sun_path, path.c_str(), sizeof(address.sun_path) - 1);
    descriptor_ = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    require(::bind(descriptor_, reinterpret_cast<sockaddr*>(&address), sizeof(address)) == 0,
            "bind");
    endpoint_.socket_path = path;
  }
  constexpr int kWaiting = 8;
  require(::listen(descriptor_, kWaiting) == 0, "listen");
  thread_ = std::thread([this] { serve(); });
}

StreamServer::~StreamServer() {
  interrupt_.raise();
  thread_.join();
  ::close(descriptor_);
}

void StreamServer::serve() {
  while (interrupt_.waitFor(descriptor_, POLLIN, kLong) == Interrupt::Wait::kReady) {
    const int client = ::accept4(descriptor_, nullptr, nullptr, SOCK_CLOEXEC);
    if (client >= 0) {
      StreamPeer peer(client, connections_++, interrupt_);
      script_(peer);
      ::close(client);
    }
  }
}

}  // namespace fast_edi::testing
