// Short runs of the scripts beside this file, which judge themselves.

#include <string>

#include <gmock/gmock.h>

#include "support/command.hpp"

namespace fast_edi {
namespace {

using ::testing::HasSubstr;

testing::CommandResult runScript(const std::string& name, const std::string& arguments) {
  return testing::runCommand("timeout --kill-after=20 150 '" FAST_EDI_SOURCE_DIR "/test/faults/" +
                             name + "' " + arguments);
}

TEST(Reload, LeavesTheManagerAlive) {
  // So few cycles show crashes and a nodelet that stays in memory (some 10 MB each); smaller leaks
  // are found by the sanitizers and by a hundred cycles of the script.
  const auto result = runScript("reload", "--cycles 8");
  EXPECT_EQ(result.exit_code, 0) << result.output;
  EXPECT_THAT(result.output, HasSubstr("8 cycles: the manager lives"));
}

TEST(Reload, LeavesASingleThreadedManagerAlive) {
  const auto result = runScript("reload", "--cycles 8 --worker-threads 1");
  EXPECT_EQ(result.exit_code, 0) << result.output;
  EXPECT_THAT(result.output, HasSubstr("8 cycles: the manager lives"));
}

class Fault : public ::testing::TestWithParam<const char*> {};

TEST_P(Fault, LosesNoFrameButThoseOfTheSilence) {
  const auto result = runScript("run", std::string("--only ") + GetParam());
  EXPECT_EQ(result.exit_code, 0) << result.output;
}

INSTANTIATE_TEST_SUITE_P(All, Fault,
                         ::testing::Values("driver", "manager", "loader", "node", "consumer"));

}  // namespace
}  // namespace fast_edi
