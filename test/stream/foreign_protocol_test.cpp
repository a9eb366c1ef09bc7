#include "stream/foreign_protocol.hpp"

#include <gmock/gmock.h>

namespace fast_edi {
namespace {

using ::testing::HasSubstr;

TEST(ForeignProtocol, IsNamed) {
  EXPECT_THAT(describeForeign("HTTP/1.1 200 OK"), HasSubstr("web server"));
  EXPECT_THAT(describeForeign("#!AER-DAT4.0\r\n"), HasSubstr("AEDAT file"));
  EXPECT_THAT(describeForeign(std::string("\x15\x03\x01\x00\x02\x02\x46", 7)), HasSubstr("TLS"));
  EXPECT_THAT(describeForeign(std::string("\x16\x03", 2)), HasSubstr("TLS"));
}

TEST(ForeignProtocol, IsShownWhenItHasNoName) {
  EXPECT_EQ(describeForeign(""), "nothing");
  EXPECT_EQ(describeForeign(std::string("\x00\x7f\xff", 3)), "the bytes 00 7f ff");
  EXPECT_EQ(describeForeign(std::string(100, 'a')),
            "the bytes 61 61 61 61 61 61 61 61 61 61 61 61");
}

}  // namespace
}  // namespace fast_edi
