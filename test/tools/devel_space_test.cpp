/// The devel space of the build, used as after `. devel/setup.bash`.
#include <gmock/gmock.h>

#include <sstream>
#include <string>

#include "support/command.hpp"

namespace fast_edi {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(DevelSpace, RosrunFindsEveryTool) {
  std::istringstream tools(FAST_EDI_TOOLS);
  int count = 0;
  for (std::string tool; tools >> tool; ++count) {
    const auto result =
        testing::runCommand("bash -c '. \"$0/setup.bash\" && exec rosrun fast_edi " + tool +
                            " --help' '" + FAST_EDI_DEVEL_SPACE + "'");
    EXPECT_EQ(result.exit_code, 0) << tool;
    EXPECT_THAT(result.output, HasSubstr("Usage: ")) << tool;
    EXPECT_THAT(result.output, Not(HasSubstr("non-unique executable"))) << tool;
  }
  EXPECT_GT(count, 0);
}

}  // namespace
}  // namespace fast_edi
