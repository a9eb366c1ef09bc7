/// \file
/// What the command-line tools have in common: words that are no options, the parameters they
/// name, warnings, and the end of a tool that failed.
#pragma once

#include <cstdint>
#include <exception>
#include <functional>
#include <iostream>
#include <string>
#include <vector>

#include <yaml-cpp/yaml.h>
#include <boost/program_options.hpp>

#include "fast_edi/config/parameters_from_yaml.hpp"
#include "fast_edi/ros/bag_reader.hpp"

namespace fast_edi {
namespace tools {

// Exit codes of tools that read recordings.
constexpr int kDone = 0;
constexpr int kFailed = 1;
constexpr int kInputIncomplete = 2;  ///< cut short or damaged; the rest of it was used

/// Options, and words that are none.
/// \param words of the command line that are no options, in order
/// \throws boost::program_options::error for an unknown or incomplete option; that a required one
/// is
///         missing shows in notify() of the result
inline boost::program_options::variables_map readCommandLine(
    int argc, char** argv, const boost::program_options::options_description& options,
    std::vector<std::string>& words) {
  namespace po = boost::program_options;
  po::options_description all;
  all.add(options).add_options()("word", po::value<std::vector<std::string>>());
  po::positional_options_description positional;
  positional.add("word", -1);
  po::variables_map values;
  po::store(po::command_line_parser(argc, argv).options(all).positional(positional).run(), values);
  if (values.count("word") > 0) {
    words = values["word"].as<std::vector<std::string>>();
  }
  return values;
}

/// Tells one recording and name:=value apart.
/// \throws boost::program_options::error for a second recording
inline void sortWords(const std::vector<std::string>& words, std::string& bag,
                      std::vector<std::string>& overrides) {
  for (const std::string& word : words) {
    if (word.find(":=") != std::string::npos) {
      overrides.push_back(word);
    } else if (bag.empty()) {
      bag = word;
    } else {
      throw boost::program_options::error("one recording at a time, got " + bag + " and " + word);
    }
  }
}

/// \param config YAML file, or empty: the overrides alone
/// \throws ParameterError
inline LoadedParameters loadParameters(const std::string& config,
                                       const std::vector<std::string>& overrides) {
  if (!config.empty()) {
    return parametersFromFile(config, overrides);
  }
  YAML::Node root(YAML::NodeType::Map);
  applyOverrides(root, overrides);
  return parametersFromYaml(root, ".");
}

inline void printWarnings(const LoadedParameters& parameters) {
  for (const std::string& warning : parameters.warnings) {
    std::cerr << "warning: " << warning << "\n";
  }
}

/// Each damaged place of a recording.
inline void printDamage(const std::string& path, const BagReader& reader) {
  for (const BagDamage& damage : reader.damage()) {
    std::cerr << "warning: " << path << ", byte " << damage.offset << ": " << damage.what << "\n";
  }
}

/// \param messages that were left out because they contradict themselves
inline void printMalformed(std::uint64_t messages) {
  if (messages > 0) {
    std::cerr << "warning: " << messages << " messages contradict themselves and were not used\n";
  }
}

/// Does a tool's work and says why it failed.
/// \return what \p work returns, or kFailed
inline int runTool(const std::string& name, const std::function<int()>& work) {
  try {
    return work();
  } catch (const boost::program_options::error& error) {
    std::cerr << name << ": " << error.what() << " (see --help)\n";
  } catch (const std::exception& error) {
    std::cerr << name << ": " << error.what() << "\n";
  }
  return kFailed;
}

}  // namespace tools
}  // namespace fast_edi
