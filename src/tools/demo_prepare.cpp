/// \file
/// `demo_prepare`: looks at a recording and its parameters before `launch/demo` plays it, and says
/// how the launch file is to be called.

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

#include <yaml-cpp/yaml.h>
#include <boost/program_options.hpp>

#include "command_line.hpp"
#include "fast_edi/bags/bag_error.hpp"
#include "fast_edi/bags/bag_reader.hpp"
#include "fast_edi/bags/topic_names.hpp"
#include "fast_edi/config/parameters_from_yaml.hpp"

namespace {

namespace fs = std::filesystem;
namespace po = boost::program_options;
namespace tools = fast_edi::tools;

struct Arguments {
  std::string bag;
  std::string config;
  std::string parameters_file;
  fast_edi::TopicNames topics;
  std::vector<std::string> overrides;
  bool overwrite = false;
};

/// \return false when help was asked for and given
bool parseArguments(int argc, char** argv, Arguments& arguments) {
  fast_edi::TopicNames& topics = arguments.topics;
  po::options_description visible("Options");
  visible.add_options()("help,h", "print this")(
      "in", po::value(&arguments.bag)->required()->value_name("BAG"), "recording")(
      "config", po::value(&arguments.config)->required()->value_name("YAML"),
      "YAML file with the parameters")(
      "parameters-out", po::value(&arguments.parameters_file)->required()->value_name("YAML"),
      "YAML file to write all parameters to, those given as name:=value included")(
      "camera-info", po::value(&topics.camera_info)->value_name("TOPIC"),
      "calibration; the sibling of --image by default, may be missing");
  tools::addTopicOptions(visible, topics);
  tools::addForceOption(visible, arguments.overwrite);
  auto values = tools::readCommandLine(
      argc, argv, visible,
      {"Usage: demo_prepare --in BAG --config YAML --parameters-out YAML [options] "
       "[parameter:=value ...]\n\n"
       "Checks a recording and parameters, finds the topics where they have other names "
       "than the\ndriver's, and prints its length [s] and launch/demo.launch's arguments, one "
       "on each line.\n",
       "0 done; 1 failed."},
      &arguments.overrides);
  if (!values) {
    return false;
  }
  po::notify(*values);
  return true;
}

/// One file with everything, since roslaunch would replace maps (`biases`) instead of merging them.
void writeParameters(const Arguments& arguments) {
  YAML::Node root = YAML::LoadFile(arguments.config);
  fast_edi::applyOverrides(root, arguments.overrides);
  // They are relative to the file that names them, which is no longer the one that is read.
  for (const char* key : {"response_file", "biases"}) {
    const YAML::Node value = root[key];  // biases may be a map
    if (value.IsDefined() && value.IsScalar() && !value.Scalar().empty()) {
      root[key] = (fs::absolute(arguments.config).parent_path() / value.Scalar()).string();
    }
  }
  std::ofstream file(arguments.parameters_file);
  file << root << "\n";
  if (!file.flush()) {
    throw std::runtime_error("cannot write " + arguments.parameters_file);
  }
}

/// Where the nodelet publishes, beside the frames, as roslaunch wants it: without the first slash.
std::string outputNamespace(const fast_edi::TopicNames& topics) {
  const std::string name = fast_edi::topicNamespace(topics.image);
  return name.empty() ? "/" : name.substr(name.front() == '/' ? 1 : 0);
}

int run(const Arguments& arguments) {
  tools::requireFree(arguments.parameters_file, arguments.overwrite);
  const fast_edi::LoadedParameters parameters =
      fast_edi::parametersFromFile(arguments.config, arguments.overrides);
  tools::printWarnings(parameters);
  const fast_edi::BagReader reader(arguments.bag);
  if (!reader.damage().empty()) {
    throw fast_edi::BagError(arguments.bag + " is cut short or damaged (at byte " +
                             std::to_string(reader.damage().front().offset) + ": " +
                             reader.damage().front().what +
                             "); rosbag cannot play it, deblur_bag can read it");
  }
  const fast_edi::TopicNames topics = tools::topicsIn(reader, arguments.topics, arguments.bag);
  writeParameters(arguments);
  std::cout << "seconds " << std::lround(std::ceil(reader.duration().toSec())) << "\n"
            << "namespace:=" << outputNamespace(topics) << "\n"
            << "events:=" << topics.events << "\n"
            << "image:=" << topics.image << "\n"
            << "exposure:=" << topics.exposure << "\n"
            << "camera_info:=" << topics.cameraInfo() << "\n";
  std::cerr << arguments.bag << ": " << reader.messageCount() << " messages in "
            << reader.duration() << " s\n";
  return tools::kDone;
}

}  // namespace

int main(int argc, char** argv) {
  return tools::runTool("demo_prepare", [argc, argv] {
    Arguments arguments;
    return parseArguments(argc, argv, arguments) ? run(arguments) : tools::kDone;
  });
}
