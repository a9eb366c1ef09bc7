/// \file
#pragma once

#include <cstdint>
#include <string>

namespace fast_edi {

/// Where a server of one stream is.
struct StreamEndpoint {
  std::string address;      ///< name or number of a host, for TCP
  std::uint16_t port = 0;   ///< TCP
  std::string socket_path;  ///< of a local (Unix) socket, which is used instead if not empty
};

/// "127.0.0.1:7777" or the path of the socket.
inline std::string toString(const StreamEndpoint& endpoint) {
  return endpoint.socket_path.empty() ? endpoint.address + ":" + std::to_string(endpoint.port)
                                      : endpoint.socket_path;
}

}  // namespace fast_edi
