#include "command_line.hpp"

#include <cstdio>
#include <exception>
#include <filesystem>
#include <iostream>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <system_error>

#include <yaml-cpp/yaml.h>

#include "fast_edi/bags/bag_error.hpp"

namespace fast_edi {
namespace tools {
namespace {

namespace po = boost::program_options;

/// More notes than this are of no use.
constexpr std::size_t kMaxDamageNotes = 10;
constexpr const char* kWord = "word";

void printHelp(const po::options_description& options, const HelpText& text) {
  std::ostringstream described;
  described << options;
  // Options in groups begin with a line of their own.
  const std::string lines = described.str();
  std::cout << text.usage << (lines.front() == '\n' ? "" : "\n") << lines << "\n";
  if (text.usage.find("parameter:=value") != std::string::npos) {
    std::cout << "Parameters: `rosrun fast_edi list_parameters` lists them.\n\n";
  }
  std::cout << "Exit code: " << text.exit_codes << "\n";
}

/// Says how the tool is called, too: whoever calls it without arguments does not know.
class CalledWithoutArguments : public po::error {
 public:
  /// \param usage its first paragraph is shown
  explicit CalledWithoutArguments(const std::string& usage)
      : po::error("called without arguments"), usage_(usage.substr(0, usage.find("\n\n"))) {}
  const std::string& usage() const { return usage_; }

 private:
  std::string usage_;
};

void refuseEmptyValues(const po::parsed_options& parsed) {
  for (const po::option& option : parsed.options) {
    for (const std::string& value : option.value) {
      if (value.empty()) {
        throw po::error(option.string_key == kWord ? "an argument is empty"
                                                   : "--" + option.string_key + " is empty");
      }
    }
  }
}

}  // namespace

po::typed_value<std::string>* textOption(std::string& target, const char* name) {
  return po::value(&target)->default_value(target)->value_name(name);
}

void addForceOption(po::options_description& options, bool& overwrite) {
  options.add_options()("force", po::bool_switch(&overwrite), "replace outputs that exist");
}

void refuseInput(const std::string& output, const std::vector<std::string>& inputs) {
  for (const std::string& input : inputs) {
    std::error_code ignored;  // one that does not exist is not the same
    if (std::filesystem::equivalent(input, output, ignored)) {
      throw std::runtime_error("cannot write " + output + ": it is the input");
    }
  }
}

TopicNames topicsIn(const MessageSource& recording, const TopicNames& named,
                    const std::string& name) {
  TopicNames topics = guessTopics(named, recording.connections());
  std::cerr << guessText(named, topics, recording.connections());
  const std::string faults = checkTopics(topics, recording.connections());
  if (!faults.empty()) {
    throw BagError(name + ": " + faults);
  }
  return topics;
}

void addTopicOptions(po::options_description& options, TopicNames& topics) {
  options.add_options()("events", textOption(topics.events, "TOPIC"), "event arrays")(
      "image", textOption(topics.image, "TOPIC"), "frames")(
      "exposure", textOption(topics.exposure, "TOPIC"), "exposure lengths [us]; may be missing");
}

std::optional<po::variables_map> readCommandLine(int argc, char** argv,
                                                 const po::options_description& options,
                                                 const HelpText& text,
                                                 std::vector<std::string>* words) {
  if (argc <= 1 && text.needs_arguments) {
    throw CalledWithoutArguments(text.usage);
  }
  po::options_description all;
  all.add(options).add_options()(kWord, po::value<std::vector<std::string>>());
  po::positional_options_description positional;
  positional.add(kWord, -1);
  const po::parsed_options parsed =
      po::command_line_parser(argc, argv).options(all).positional(positional).run();
  po::variables_map values;
  po::store(parsed, values);
  if (values.count("help") > 0) {
    printHelp(options, text);
    return std::nullopt;
  }
  refuseEmptyValues(parsed);
  if (values.count(kWord) > 0) {
    const auto& given = values[kWord].as<std::vector<std::string>>();
    if (words == nullptr) {
      throw po::error("expected options only, got \"" + given.front() + "\"");
    }
    *words = given;
  }
  return values;
}

void sortWords(const std::vector<std::string>& words, std::vector<std::string>& recordings,
               std::vector<std::string>& overrides) {
  for (const std::string& word : words) {
    (word.find(":=") != std::string::npos ? overrides : recordings).push_back(word);
  }
}

void requireRecordings(const std::vector<std::string>& words, std::vector<std::string>& recordings,
                       std::vector<std::string>& overrides) {
  sortWords(words, recordings, overrides);
  if (recordings.empty()) {
    throw po::error("expected a RECORDING");
  }
}

void requireFree(const std::string& path, bool overwrite) {
  namespace fs = std::filesystem;
  if (fs::is_directory(path)) {
    throw std::runtime_error("cannot write " + path + ": it is a directory");
  }
  if (!overwrite && fs::exists(path)) {
    throw std::runtime_error("cannot write " + path + ": it exists already (--force replaces it)");
  }
}

LoadedParameters loadParameters(const std::string& config,
                                const std::vector<std::string>& overrides) {
  if (!config.empty()) {
    return parametersFromFile(config, overrides);
  }
  YAML::Node root(YAML::NodeType::Map);
  applyOverrides(root, overrides);
  return parametersFromYaml(root, ".");
}

LoadedParameters loadParametersFor(const MessageSource& recording, const std::string& config,
                                   std::vector<std::string> overrides) {
  if (const std::optional<BiasConfiguration> biases = recording.biases()) {
    std::string text = "biases:={";
    for (const auto& [name, bias] :
         {std::pair("DiffBn", biases->diff), {"OnBn", biases->on}, {"OffBn", biases->off}}) {
      text += std::string(name) + "_coarse: " + std::to_string(bias.coarse) + ", " + name +
              "_fine: " + std::to_string(bias.fine) + ", ";
    }
    overrides.insert(overrides.begin(), text + "coarse_convention: libcaer}");
  }
  LoadedParameters parameters = loadParameters(config, overrides);
  DeblurParameters& deblur = parameters.deblur;
  if (recording.knowsExposures()) {
    if (deblur.stamp_reference != ExposureInstant::kMid ||
        deblur.exposure_source != ExposureSource::kTopic) {
      parameters.warnings.emplace_back(
          "the recording has the exposure of each frame: stamp_reference and exposure_source are "
          "not used");
    }
    deblur.stamp_reference = ExposureInstant::kMid;
    deblur.exposure_source = ExposureSource::kTopic;
  }
  return parameters;
}

void printWarnings(const LoadedParameters& parameters) {
  for (const std::string& warning : parameters.warnings) {
    std::cerr << "warning: " << warning << "\n";
  }
}

void printDamage(const std::string& path, const std::vector<BagDamage>& damage) {
  for (std::size_t i = 0; i < damage.size() && i < kMaxDamageNotes; ++i) {
    std::cerr << "warning: " << path << ", at byte " << damage[i].offset << ": " << damage[i].what
              << "\n";
  }
  if (damage.size() > kMaxDamageNotes) {
    std::cerr << "warning: " << path << ": " << damage.size() - kMaxDamageNotes
              << " more damaged places\n";
  }
}

void printMalformed(std::uint64_t messages) {
  if (messages > 0) {
    std::cerr << "warning: " << messages << " messages contradict themselves and were not used\n";
  }
}

int runTool(const std::string& name, const std::function<int()>& work) {
  try {
    const int code = work();
    std::cout.flush();
    if (!std::cout || std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
      throw std::runtime_error("standard output cannot be written");
    }
    return code;
  } catch (const CalledWithoutArguments& error) {
    std::cerr << name << ": " << error.what() << " (see --help)\n" << error.usage() << "\n";
  } catch (const po::error& error) {
    std::cerr << name << ": " << error.what() << " (see --help)\n";
  } catch (const std::exception& error) {
    std::cerr << name << ": " << error.what() << "\n";
  }
  return kFailed;
}

}  // namespace tools
}  // namespace fast_edi
