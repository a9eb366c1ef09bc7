#include "recording/output_path.hpp"

#include <gmock/gmock.h>

#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "fast_edi/recording/recording_error.hpp"
#include "support/temporary_directory.hpp"

namespace fast_edi {
namespace {

namespace fs = std::filesystem;

TEST(OutputPath, HasItsNameWhenItIsComplete) {
  const TemporaryDirectory directory;
  const std::string path = directory.file("out");
  const OutputPath output(path, false);
  EXPECT_EQ(output.active(), path + ".active");
  std::ofstream(output.active()) << "whole";
  EXPECT_FALSE(fs::exists(path));
  output.complete();
  EXPECT_TRUE(fs::exists(path));
  EXPECT_FALSE(fs::exists(output.active()));
  EXPECT_THROW(output.complete(), RecordingError) << "there is none any more";
}

TEST(OutputPath, ReplacesNothingUnlessItMay) {
  const TemporaryDirectory directory;
  const std::string path = directory.file("out");
  std::ofstream(path + ".active") << "of another";
  EXPECT_THROW(OutputPath(path, false), RecordingError);
  EXPECT_NO_THROW(OutputPath(path, true));
  fs::create_directory(path);
  EXPECT_THROW(OutputPath(path, true), RecordingError);
}

TEST(OutputPath, ReplacesFilesAlone) {
  const TemporaryDirectory directory;
  const std::string path = directory.file("out");
  ASSERT_EQ(::mkfifo(path.c_str(), S_IRWXU), 0);
  EXPECT_THROW(OutputPath(path, true), RecordingError);
  EXPECT_TRUE(fs::is_fifo(path));
}

}  // namespace
}  // namespace fast_edi
