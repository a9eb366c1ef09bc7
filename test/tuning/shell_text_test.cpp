#include "tuning/shell_text.hpp"

#include <gmock/gmock.h>

#include "support/command.hpp"

namespace fast_edi {
namespace {

TEST(ShellText, PlainWordsStayPlain) {
  EXPECT_EQ(shellText({"rosrun", "fast_edi", "deblur_bag", "--in", "/a/b_c.bag",
                       "time_offset_us:=-1500"}),
            "rosrun fast_edi deblur_bag --in /a/b_c.bag time_offset_us:=-1500");
  EXPECT_EQ(shellText({}), "");
}

TEST(ShellText, AShellReadsTheSameWords) {
  const std::string odd = "it's \"my\" robot & $HOME [1] (ü)*";
  EXPECT_EQ(testing::runCommand("printf '%s|' " + shellText({odd, "", "a b"})).output,
            odd + "||a b|");
}

}  // namespace
}  // namespace fast_edi
