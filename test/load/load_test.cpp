// Short runs of the scripts beside this file, which judge themselves.

#include <string>

#include <gmock/gmock.h>

#include "support/command.hpp"

namespace fast_edi {
namespace {

testing::CommandResult runScript(const std::string& arguments) {
  return testing::runCommand("timeout --kill-after=20 150 '" FAST_EDI_SOURCE_DIR "/test/load/'" +
                             arguments);
}

TEST(Load, NoFrameIsLostAndMemoryIsBoundedWithinTheProcess) {
  const auto result = runScript("run --only in_process --seconds 2 --factors 1 10 --no-plot");
  EXPECT_EQ(result.exit_code, 0) << result.output;
}

TEST(Load, NoFrameIsLostAndMemoryIsBoundedOverTcp) {
  const auto result = runScript("run --only tcp --seconds 2 --factors 10 --no-plot");
  EXPECT_EQ(result.exit_code, 0) << result.output;
}

TEST(Soak, MemoryStaysAndNoFrameIsLost) {
  const auto result = runScript("soak --minutes 1 --segment-seconds 6 --speed 1 --no-plot");
  EXPECT_EQ(result.exit_code, 0) << result.output;
}

}  // namespace
}  // namespace fast_edi
