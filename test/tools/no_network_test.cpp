/// No command-line tool needs the network, or tries to reach it.
#include <string>

#include <gmock/gmock.h>

#include "rostest/recording.hpp"
#include "support/command.hpp"
#include "support/temporary_directory.hpp"

namespace fast_edi {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// Runs a command whose sockets are watched.
testing::CommandResult runWatched(const std::string& command) {
  return testing::runCommand("LD_PRELOAD='" FAST_EDI_NO_NETWORK "' " + command);
}

std::string tool(const std::string& name) {
  return std::string(FAST_EDI_TOOLS_DIR) + "/" + name + " ";
}

void expectSilent(const std::string& command) {
  const testing::CommandResult result = runWatched(command);
  EXPECT_EQ(result.exit_code, 0) << command << "\n" << result.output;
  EXPECT_THAT(result.output, Not(HasSubstr("network access"))) << command;
}

TEST(NoNetwork, TheWatchSeesASocket) {
  const testing::CommandResult result =
      runWatched("/usr/bin/python3 -c 'import socket; socket.socket(socket.AF_INET)'");
  EXPECT_NE(result.exit_code, 0);
  EXPECT_THAT(result.output, HasSubstr("network access"));
}

TEST(NoNetwork, ToolsReachForNone) {
  const TemporaryDirectory directory;
  const std::string input = directory.file("in.bag");
  test::RecordingSettings settings;
  settings.frames = 3;
  test::writeBag(test::makeRecording(settings), "/dvs", input);
  const std::string config = "'" FAST_EDI_SOURCE_DIR "/cfg/davis346.yaml'";

  expectSilent(tool("deblur_bag") + "--in '" + input + "' --out '" + directory.file("out.bag") +
               "' --config " + config);
  expectSilent(tool("evaluate") + "'" + input + "' --config " + config + " --output '" +
               directory.file("evaluation") + "'");
  expectSilent(tool("tune") + "'" + input + "' --config " + config + " --screenshot '" +
               directory.file("tune.png") + "'");
  expectSilent(tool("simulate_davis") + "--frames 1 --out '" + directory.file("sim.bag") + "'");
  expectSilent(tool("contrast_from_bias") + config);
  expectSilent(tool("list_parameters") + "--markdown");
}

}  // namespace
}  // namespace fast_edi
