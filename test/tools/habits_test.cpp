/// What all command-line tools have in common, of whichever the build makes.
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "support/command.hpp"
#include "support/temporary_directory.hpp"

namespace fast_edi {
namespace {

using ::testing::AllOf;
using ::testing::AnyOf;
using ::testing::HasSubstr;
using testing::runCommand;

const std::string kTools = std::string(FAST_EDI_TOOLS_DIR) + "/";
const std::string kDemoBag = std::string(FAST_EDI_SOURCE_DIR) + "/bags/demo.bag";
const std::string kConfig = std::string(FAST_EDI_SOURCE_DIR) + "/cfg/davis346.yaml";
/// What a shell, an option or XML could take for something else.
const std::string kOddName = "it's \"my\" robot & $HOME [1] (ü)";

/// A command that writes, and where to.
struct Writing {
  std::string arguments;
  std::string output;
};

std::vector<std::string> toolNames() {
  std::istringstream names(FAST_EDI_TOOLS);
  return {std::istream_iterator<std::string>(names), {}};
}

std::string quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) {
    result += c == '\'' ? std::string("'\\''") : std::string(1, c);
  }
  return result + "'";
}

std::string contentOf(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream content;
  content << file.rdbuf();
  return content.str();
}

/// Characters that a terminal of usual width shows, and some.
constexpr std::size_t kWidestLine = 105;

class ToolHabits : public ::testing::TestWithParam<std::string> {
 protected:
  std::string tool() const { return kTools + GetParam() + " "; }
};

TEST_P(ToolHabits, ExplainsItself) {
  for (const char* option : {"--help", "-h"}) {
    const auto result = runCommand(tool() + option);
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_EQ(result.output.rfind("Usage: " + GetParam(), 0), 0u) << result.output;
    EXPECT_THAT(result.output, AllOf(HasSubstr("--help"), HasSubstr("\nExit code: 0 ")));
    EXPECT_EQ(result.output.find("parameter:=value") != std::string::npos,
              result.output.find("list_parameters` lists them") != std::string::npos);
    EXPECT_THAT(result.output, Not(HasSubstr(" arg "))) << "an option without a name for its value";
    EXPECT_THAT(result.output, Not(HasSubstr("\n\n\n")));
    std::istringstream lines(result.output);
    for (std::string line; std::getline(lines, line);) {
      EXPECT_LE(line.size(), kWidestLine) << line;
    }
  }
  EXPECT_EQ(runCommand(tool() + "--help >/dev/full").exit_code, 1);
}

TEST_P(ToolHabits, RefusesWrongArguments) {
  for (const char* arguments : {"--nonsense", "--nonsense=1", "--in", "''"}) {
    const auto result = runCommand(tool() + arguments);
    EXPECT_EQ(result.exit_code, 1) << arguments;
    EXPECT_EQ(result.output.rfind(GetParam() + ": ", 0), 0u) << arguments << ": " << result.output;
    EXPECT_THAT(result.output, HasSubstr("(see --help)")) << arguments;
  }
}

TEST_P(ToolHabits, RefusesToDoNothing) {
  const auto result = runCommand(tool());
  if (GetParam() == "list_parameters") {  // there is nothing that it could be told
    EXPECT_EQ(result.exit_code, 0);
    return;
  }
  EXPECT_EQ(result.exit_code, 1);
  const std::string reason = GetParam() + ": called without arguments (see --help)\n";
  EXPECT_EQ(result.output.rfind(reason + "Usage: " + GetParam() + " ", 0), 0u) << result.output;
  EXPECT_EQ(result.output.find("\n\n"), std::string::npos) << "all of the help";
}

INSTANTIATE_TEST_SUITE_P(, ToolHabits, ::testing::ValuesIn(toolNames()),
                         [](const auto& tested) { return tested.param; });

/// A recording in a folder with an odd name.
class ToolFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directory(folder_);
    ASSERT_EQ(runCommand(kTools + "simulate_davis --frames 3 --width 48 --height 36 --out " +
                         quoted(bag_))
                  .exit_code,
              0);
  }

  std::string file(const std::string& name) const { return folder_ + "/" + name; }

  /// What each tool writes; a new tool has its line here, or below.
  std::map<std::string, std::vector<Writing>> writings() const {
    const std::string in = " --in " + quoted(bag_);
    const std::string config = " --config " + quoted(kConfig);
    return {
        {"convert_recording",
         {{quoted(bag_) + " " + quoted(file("out.bag")), file("out.bag")},
          {quoted(bag_) + " " + quoted(file("out.aedat4")), file("out.aedat4")}}},
        {"deblur_bag",
         {{in + config + " --out " + quoted(file("out.bag")), file("out.bag")},
          {in + config + " --fps 100 --video " + quoted(file("out.avi")), file("out.avi")}}},
        {"demo_prepare",
         {{in + config + " --parameters-out " + quoted(file("out.yaml")), file("out.yaml")}}},
        {"demo_report",
         {{" --in " + quoted(bag_) + " --live " + quoted(file("live.bag")) + config +
               " --picture " + quoted(file("out.png")),
           file("out.png")}}},
        {"evaluate",
         {{quoted(bag_) + config + " --full-reference-only --output " + quoted(file("report")),
           file("report/report.md")}}},
        {"simulate_davis",
         {{"--frames 1 --width 48 --height 36 --out " + quoted(file("new.bag")), file("new.bag")}}},
        {"tune",
         {{quoted(bag_) + config + " --as-given --screenshot " + quoted(file("out.png")),
           file("out.png")}}},
        {"trajectory_error",
         {{quoted(bag_) + " --estimate /dvs/ground_truth/pose --plot " + quoted(file("plot.png")),
           file("plot.png")}}},
        {"validate_bag",
         {{quoted(bag_) + config + " --output " + quoted(file("plots")), file("plots/shift.png")}}},
    };
  }

  TemporaryDirectory directory_;
  const std::string folder_ = directory_.file(kOddName);
  const std::string bag_ = file("a recording.bag");
};

class ToolOutputs : public ToolFiles, public ::testing::WithParamInterface<std::string> {};

TEST_P(ToolOutputs, ReplaceOnlyWhatTheyAreTold) {
  const auto all = writings();
  const auto found = all.find(GetParam());
  if (found == all.end()) {
    EXPECT_THAT(GetParam(), AnyOf("contrast_from_bias", "count_tags", "list_parameters"))
        << "is what it writes in the table of this test?";
    return;
  }
  const std::string tool = kTools + GetParam() + " ";
  EXPECT_THAT(runCommand(tool + "--help").output, HasSubstr("  --force "));
  const std::string earlier = "of somebody else";
  for (const Writing& writing : found->second) {
    std::filesystem::create_directories(std::filesystem::path(writing.output).parent_path());
    std::ofstream(writing.output) << earlier;
    const auto refused = runCommand(tool + writing.arguments);
    EXPECT_EQ(refused.exit_code, 1) << refused.output;
    EXPECT_THAT(refused.output, AllOf(HasSubstr(writing.output),
                                      HasSubstr("exists already (--force replaces it)")));
    EXPECT_EQ(contentOf(writing.output), earlier);
  }
}

INSTANTIATE_TEST_SUITE_P(, ToolOutputs, ::testing::ValuesIn(toolNames()),
                         [](const auto& tested) { return tested.param; });

// Names that a shell, say, would take apart.
TEST_F(ToolFiles, MayHaveAnyName) {
  const auto all = writings();
  for (const char* name : {"deblur_bag", "demo_prepare", "evaluate", "simulate_davis", "tune"}) {
    for (const Writing& writing : all.at(name)) {
      const auto written = runCommand(kTools + name + " " + writing.arguments);
      EXPECT_EQ(written.exit_code, 0) << name << ": " << written.output;
      EXPECT_FALSE(contentOf(writing.output).empty()) << name << ": " << writing.output;
      const auto again = runCommand(kTools + name + " --force " + writing.arguments);
      EXPECT_EQ(again.exit_code, 0) << name << ": " << again.output;
    }
  }
}

}  // namespace
}  // namespace fast_edi
