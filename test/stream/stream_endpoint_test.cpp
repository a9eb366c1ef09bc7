#include "stream/stream_endpoint.hpp"

#include <gtest/gtest.h>

namespace fast_edi {
namespace {

TEST(StreamEndpoint, IsShownAsUsersWriteIt) {
  StreamEndpoint endpoint;
  endpoint.address = "robot";
  endpoint.port = 7777;
  EXPECT_EQ(toString(endpoint), "robot:7777");
  endpoint.socket_path = "/tmp/events.sock";
  EXPECT_EQ(toString(endpoint), "/tmp/events.sock");
}

}  // namespace
}  // namespace fast_edi
