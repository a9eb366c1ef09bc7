/// What launch/dependencies.bash does for launch/demo and test/run.
#include <gmock/gmock.h>

#include <fstream>
#include <string>

#include "support/command.hpp"
#include "support/temporary_directory.hpp"

namespace fast_edi {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// Runs a line of bash that can use the functions.
testing::CommandResult runBash(const std::string& line, const std::string& argument = "") {
  const TemporaryDirectory directory;
  const std::string script = directory.file("script");
  std::ofstream(script) << ". '" FAST_EDI_SOURCE_DIR "/launch/dependencies.bash'\n" << line << "\n";
  const std::string words = directory.file("argument");
  std::ofstream(words) << argument;
  return testing::runCommand("bash '" + script + "' \"$(cat '" + words + "')\"");
}

TEST(Dependencies, FoldersThatToolsTakeApartAreRefusedWithTheReason) {
  for (const char* folder :
       {"/home/me/fast_edi", "/home/my robot/fast_edi", "/home/ü/a+b,c=d@e~f"}) {
    const auto result = runBash("fast_edi_refuse_folder \"$1\"", folder);
    EXPECT_EQ(result.exit_code, 0) << folder;
    EXPECT_EQ(result.output, "");
  }
  for (const char* folder : {"/it's", "/a\"b", "/a$b", "/a`b", "/a[1]", "/a(1)", "/a&b", "/a:b",
                             "/a;b", "/a#b", "/a*b", "/a\\b"}) {
    const auto result = runBash("fast_edi_refuse_folder \"$1\"", folder);
    EXPECT_EQ(result.exit_code, 1) << folder;
    EXPECT_THAT(result.output,
                HasSubstr(std::string("take apart the name of the folder ") + folder));
  }
}

TEST(Dependencies, SanitizersOfClangAreAPackageOfTheirOwnSinceDebian12) {
  const TemporaryDirectory directory;
  const std::string release = directory.file("os-release");
  const auto packages = [&](const char* version) {
    std::ofstream(release) << "ID=debian\n" << version << "\n";
    return runBash("FAST_EDI_NOETIC=/none; fast_edi_packages test '" + release + "'").output;
  };
  EXPECT_THAT(packages("VERSION_ID=\"11\""), Not(HasSubstr("libclang-rt-dev")));
  EXPECT_THAT(packages("VERSION_ID=\"11\""), HasSubstr("\nclang\n"));
  EXPECT_THAT(packages("VERSION_ID=\"12\""), HasSubstr("\nlibclang-rt-dev\n"));
  EXPECT_THAT(packages("VERSION_CODENAME=sid"), HasSubstr("\nlibclang-rt-dev\n"));
}

}  // namespace
}  // namespace fast_edi
