/// \file
/// Loaded before a program (LD_PRELOAD) it ends the program with kExitCode when that opens a socket
/// other than one within the machine, or asks for the address of a host.
#include <netdb.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cstdio>

namespace {

constexpr int kExitCode = 97;

[[noreturn]] void refuse(const char* what) {
  std::fprintf(stderr, "network access: %s\n", what);
  std::fflush(stderr);
  ::_exit(kExitCode);
}

}  // namespace

extern "C" int socket(int domain, int type, int protocol) noexcept {
  if (domain == AF_INET || domain == AF_INET6) {
    refuse("socket()");
  }
  return static_cast<int>(::syscall(SYS_socket, domain, type, protocol));
}

extern "C" int getaddrinfo(const char*, const char*, const struct addrinfo*, struct addrinfo**) {
  refuse("getaddrinfo()");
}
