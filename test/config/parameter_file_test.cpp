#include "fast_edi/config/parameter_file.hpp"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

#include <gmock/gmock.h>

#include "support/temporary_directory.hpp"

namespace fast_edi {
namespace {

namespace fs = std::filesystem;

using ::testing::AllOf;
using ::testing::HasSubstr;

std::string contentOf(const std::string& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(ParameterFile, HasItsNameWhenItIsComplete) {
  const TemporaryDirectory directory;
  const std::string path = directory.file("parameters.yaml");
  {
    ParameterFile file(path);
    EXPECT_FALSE(fs::exists(path));
    file.write("filter: false\n");
  }
  EXPECT_EQ(contentOf(path), "filter: false\n");
  EXPECT_FALSE(fs::exists(path + ".active"));
}

TEST(ParameterFile, ReplacesAnOlderOneOnlyWhenItIsWritten) {
  const TemporaryDirectory directory;
  const std::string path = directory.file("parameters.yaml");
  std::ofstream(path) << "old";
  { const ParameterFile unused(path); }
  EXPECT_EQ(contentOf(path), "old");
  ParameterFile(path).write("new");
  EXPECT_EQ(contentOf(path), "new");
}

TEST(ParameterFile, SaysWhyItCannotBeWritten) {
  try {
    ParameterFile("/nonexistent/parameters.yaml");
    FAIL() << "expected an error";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(),
                AllOf(HasSubstr("/nonexistent/parameters.yaml"), HasSubstr("No such file")));
  }
}

}  // namespace
}  // namespace fast_edi
