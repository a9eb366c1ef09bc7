/// The program `count_tags`, run as a user runs it.
#include <filesystem>
#include <string>

#include <gmock/gmock.h>

#include "support/command.hpp"
#include "support/temporary_directory.hpp"

namespace fast_edi {
namespace {

using fast_edi::testing::CommandResult;
using fast_edi::testing::runCommand;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;

const std::string kTools = std::string(FAST_EDI_TOOLS_DIR) + "/";
const std::string kDemo = FAST_EDI_SOURCE_DIR "/bags/demo.bag";
const std::string kThresholds = " contrast_threshold_on:=0.2609 contrast_threshold_off:=0.2415";

class CountTagsTest : public ::testing::Test {
 protected:
  std::string simulate() {
    const std::string bag = directory_.file("tags.bag");
    const CommandResult result =
        runCommand(kTools + "simulate_davis --out " + bag +
                   " --frames 4 --motion shake --tags 1 --texture flat --noise none --seed 2");
    EXPECT_EQ(result.exit_code, 0) << result.output;
    return bag;
  }

  TemporaryDirectory directory_;
};

TEST_F(CountTagsTest, CountsInEachKindOfFrames) {
  const std::string bag = simulate();
  CommandResult result = runCommand(kTools + "count_tags " + bag + kThresholds);
  ASSERT_EQ(result.exit_code, 0) << result.output;
  EXPECT_THAT(result.output, HasSubstr("tags.bag, AprilTag 36h11, 4 frames deblurred of 4"));
  EXPECT_THAT(result.output, ContainsRegex("\nblurry +4 +[0-3] +[0-9.]+ % +[0-3] +0\n"));
  EXPECT_THAT(result.output, ContainsRegex("\nplain EDI +4 +4 +100.0 % +4 +0\n"));
  EXPECT_THAT(result.output, ContainsRegex("\ndeblurred +4 +4 +100.0 % +4 +0\n"));
  EXPECT_THAT(result.output, ContainsRegex("\ntruth +4 +4 +100.0 % +4 +0\n"));

  result = runCommand(kTools + "count_tags " + bag + kThresholds + " --truth /none --family 25h9");
  ASSERT_EQ(result.exit_code, 0) << result.output;
  EXPECT_THAT(result.output, ContainsRegex("\ndeblurred +4 +0 +0.0 % +0\n"));
  EXPECT_THAT(result.output, Not(HasSubstr("truth")));

  std::filesystem::resize_file(bag, std::filesystem::file_size(bag) * 4 / 5);
  result = runCommand(kTools + "count_tags " + bag + kThresholds);
  EXPECT_EQ(result.exit_code, 2) << result.output;
  EXPECT_THAT(result.output, HasSubstr("warning: " + bag));
}

TEST_F(CountTagsTest, NamesWhatIsWrong) {
  const auto fails = [](const std::string& arguments, const std::string& message) {
    const CommandResult result = runCommand(kTools + "count_tags " + arguments);
    EXPECT_EQ(result.exit_code, 1) << arguments;
    EXPECT_THAT(result.output, HasSubstr(message));
  };
  fails("/nonexistent.bag" + kThresholds, "/nonexistent.bag");
  fails(kDemo, "contrast_threshold_on");
  fails("a.bag b.bag" + kThresholds, "a.bag");
  fails(kDemo + " --family 36h12" + kThresholds, "expected one of: 36h11");
  fails(kThresholds, "expected a RECORDING");
  EXPECT_EQ(runCommand(kTools + "count_tags --help").exit_code, 0);
}

}  // namespace
}  // namespace fast_edi
