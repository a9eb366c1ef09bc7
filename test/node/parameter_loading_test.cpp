#include "node/parameter_loading.hpp"

#include <filesystem>
#include <limits>
#include <string>

#include <gtest/gtest.h>
#include <ros/package.h>

#include "fast_edi/config/parameters_from_yaml.hpp"
#include "support/comma_locale.hpp"

namespace fast_edi {
namespace {

TEST(YamlFromXmlRpc, KeepsTypesAndNesting) {
  XmlRpc::XmlRpcValue value;
  value["flag"] = true;
  value["count"] = -3;
  value["text"] = "jaer_xml";
  value["biases"]["DiffBn_coarse"] = 4;
  value["list"][0] = 1;
  value["list"][1] = "two";
  const YAML::Node yaml = yamlFromXmlRpc(value);
  ASSERT_TRUE(yaml.IsMap());
  EXPECT_TRUE(yaml["flag"].as<bool>());
  EXPECT_EQ(yaml["count"].as<int>(), -3);
  EXPECT_EQ(yaml["text"].as<std::string>(), "jaer_xml");
  EXPECT_EQ(yaml["biases"]["DiffBn_coarse"].as<int>(), 4);
  EXPECT_EQ(yaml["list"].size(), 2u);
  EXPECT_EQ(yaml["list"][1].as<std::string>(), "two");
}

TEST(YamlFromXmlRpc, KeepsEveryBitOfNumbers) {
  for (const double number : {0.1, 1.0 / 3.0, 130.0 / 6.0, 6.02214076e23, 1e-300}) {
    XmlRpc::XmlRpcValue value;
    value["x"] = number;
    EXPECT_EQ(yamlFromXmlRpc(value)["x"].as<double>(), number);
  }
}

TEST(YamlFromXmlRpc, WritesNumbersTheSameUnderEveryLocale) {
  XmlRpc::XmlRpcValue value;
  value["x"] = 0.25;
  value["n"] = 13'000'000;
  const testing::CommaLocale comma;
  EXPECT_EQ(yamlFromXmlRpc(value)["x"].Scalar(), "0.25");
  EXPECT_EQ(yamlFromXmlRpc(value)["n"].Scalar(), "13000000");
}

TEST(YamlFromXmlRpc, RefusesWhatNoParameterIs) {
  XmlRpc::XmlRpcValue value;
  char bytes[] = {1, 2, 3};
  value["biases"]["blob"] = XmlRpc::XmlRpcValue(bytes, 3);
  try {
    yamlFromXmlRpc(value);
    FAIL() << "binary data was accepted";
  } catch (const ParameterError& error) {
    EXPECT_NE(std::string(error.what()).find("parameters/biases/blob"), std::string::npos);
  }
}

TEST(MakePathsAbsolute, StartsAtTheFolderOfConfigurations) {
  YAML::Node map = YAML::Load("{response_file: a.txt, biases: sub/b.yaml, frame_id: c}");
  makePathsAbsolute(map);
  const std::string folder = ros::package::getPath("fast_edi") + "/cfg/";
  EXPECT_TRUE(std::filesystem::exists(folder + "davis346.yaml"));
  EXPECT_EQ(map["response_file"].Scalar(), folder + "a.txt");
  EXPECT_EQ(map["biases"].Scalar(), folder + "sub/b.yaml");
  EXPECT_EQ(map["frame_id"].Scalar(), "c");
}

TEST(MakePathsAbsolute, LeavesTheRestAlone) {
  const std::string text = "{response_file: \"\", biases: {kappa_n: 0.7}}";
  YAML::Node map = YAML::Load(text);
  makePathsAbsolute(map);
  EXPECT_EQ(YAML::Dump(map), YAML::Dump(YAML::Load(text)));
  map = YAML::Load("{response_file: /a.txt}");
  makePathsAbsolute(map);
  EXPECT_EQ(map["response_file"].Scalar(), "/a.txt");
  map = YAML::Load("{frame_id: c}");
  makePathsAbsolute(map);
  EXPECT_EQ(map.size(), 1u);
}

}  // namespace
}  // namespace fast_edi
