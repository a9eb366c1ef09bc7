/// The program `demo_prepare`, which writes the parameters that launch/demo plays a recording with.
#include <gmock/gmock.h>
#include <yaml-cpp/yaml.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "support/command.hpp"
#include "support/temporary_directory.hpp"

namespace fast_edi {
namespace {

const std::string kTool = std::string(FAST_EDI_TOOLS_DIR) + "/demo_prepare ";
const std::string kSource = FAST_EDI_SOURCE_DIR;

class DemoPrepare : public ::testing::Test {
 protected:
  /// The parameters written for a configuration that reads \p content.
  YAML::Node prepare(const std::string& content) {
    std::ofstream(directory_.file("mine.yaml")) << content;
    const auto result = testing::runCommand(
        kTool + "--in '" + kSource + "/bags/demo.bag' --config '" + directory_.file("mine.yaml") +
        "' --parameters-out '" + directory_.file("out/parameters.yaml") + "'");
    EXPECT_EQ(result.exit_code, 0) << result.output;
    return YAML::LoadFile(directory_.file("out/parameters.yaml"));
  }

  void SetUp() override { std::filesystem::create_directory(directory_.file("out")); }

  TemporaryDirectory directory_;
};

TEST_F(DemoPrepare, FilesNamedInTheConfigurationAreFoundFromAnywhere) {
  std::filesystem::copy_file(kSource + "/test/rostest/driver_biases.yaml",
                             directory_.file("my_biases.yaml"));
  const YAML::Node parameters = prepare("biases: my_biases.yaml\n");
  EXPECT_EQ(parameters["biases"].as<std::string>(), directory_.file("my_biases.yaml"));
}

TEST_F(DemoPrepare, KeepsBiasesThatAreGivenThemselves) {
  const YAML::Node shipped = YAML::LoadFile(kSource + "/cfg/davis346.yaml");
  const YAML::Node parameters = prepare(YAML::Dump(shipped));
  EXPECT_EQ(YAML::Dump(parameters["biases"]), YAML::Dump(shipped["biases"]));
}

}  // namespace
}  // namespace fast_edi
