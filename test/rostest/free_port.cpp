#include "rostest/free_port.hpp"

#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <stdexcept>

namespace fast_edi {
namespace test {

std::string freePort() {
  const int listener = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  socklen_t size = sizeof(address);
  auto* generic = reinterpret_cast<sockaddr*>(&address);
  if (listener < 0 || bind(listener, generic, size) != 0 ||
      getsockname(listener, generic, &size) != 0) {
    throw std::runtime_error("no free port");
  }
  close(listener);
  return std::to_string(ntohs(address.sin_port));
}

}  // namespace test
}  // namespace fast_edi
