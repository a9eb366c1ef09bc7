#include "stream/client_socket.hpp"

#include <array>
#include <string>

#include <gmock/gmock.h>

#include "stream/stream_error.hpp"
#include "stream/stream_server.hpp"

namespace fast_edi {
namespace {

using std::chrono::milliseconds;
using ::testing::HasSubstr;
using testing::StreamPeer;
using testing::StreamServer;

constexpr milliseconds kLong(20'000);

std::string refusal(const StreamEndpoint& endpoint, const Interrupt& interrupt) {
  try {
    const ClientSocket socket(endpoint, kLong, interrupt);
  } catch (const StreamError& error) {
    return error.what();
  }
  return "connected";
}

TEST(ClientSocket, ReadsUntilTheEnd) {
  const StreamServer server([](StreamPeer& peer) {
    peer.send("abc");
    peer.receive();
  });
  const Interrupt interrupt;
  ClientSocket socket(server.endpoint(), kLong, interrupt);
  std::array<std::uint8_t, 2> bytes = {};
  std::size_t count = 0;
  EXPECT_EQ(socket.read(bytes.data(), bytes.size(), kLong, count), ClientSocket::Reading::kBytes);
  EXPECT_EQ(bytes[0], 'a');
  while (count != 1 || bytes[0] != 'c') {
    ASSERT_EQ(socket.read(bytes.data(), 1, kLong, count), ClientSocket::Reading::kBytes);
  }
  EXPECT_EQ(socket.read(bytes.data(), 1, milliseconds(1), count), ClientSocket::Reading::kTimeout);
  EXPECT_EQ(count, 0U);
  socket.writeSome(bytes.data(), 1);
  EXPECT_EQ(socket.read(bytes.data(), 1, kLong, count), ClientSocket::Reading::kEnd);
}

TEST(ClientSocket, AnInterruptEndsAWait) {
  const StreamServer server([](StreamPeer& peer) { peer.waitForEnd(); });
  Interrupt interrupt;
  ClientSocket socket(server.endpoint(), kLong, interrupt);
  interrupt.raise();
  std::uint8_t byte = 0;
  std::size_t count = 0;
  EXPECT_EQ(socket.read(&byte, 1, kLong, count), ClientSocket::Reading::kInterrupted);
}

TEST(ClientSocket, SaysWhyItCannotConnect) {
  const Interrupt interrupt;
  StreamEndpoint endpoint;
  endpoint.socket_path = "/no/such/socket";
  EXPECT_THAT(refusal(endpoint, interrupt), HasSubstr("cannot connect: No such file"));
  endpoint.socket_path = std::string(200, 'x');
  EXPECT_THAT(refusal(endpoint, interrupt), HasSubstr("has 200 characters, expected at most 107"));
  StreamEndpoint tcp;
  tcp.address = "not a name";
  tcp.port = 1;
  EXPECT_THAT(refusal(tcp, interrupt), HasSubstr("no address is known for \"not a name\""));
  {
    const StreamServer gone([](StreamPeer&) {});
    tcp = gone.endpoint();
  }
  EXPECT_THAT(refusal(tcp, interrupt), HasSubstr("cannot connect: Connection refused"));
}

}  // namespace
}  // namespace fast_edi
