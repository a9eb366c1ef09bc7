/// \file
/// Habits that all command-line tools share: how they are called, what they say when they are
/// called wrongly, when they replace a file, and how they end.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <boost/program_options.hpp>

#include "fast_edi/bags/message_source.hpp"
#include "fast_edi/bags/topic_names.hpp"
#include "fast_edi/config/parameters_from_yaml.hpp"

namespace fast_edi {
namespace tools {

// Exit codes. Wrong arguments are a failure like any other.
constexpr int kDone = 0;
constexpr int kFailed = 1;            ///< no output
constexpr int kFindings = 2;          ///< done, but something is wrong with the input
constexpr int kInputIncomplete = 2;   ///< the same: cut short or damaged; the rest of it was used
constexpr int kNothingDeblurred = 3;  ///< done, but all frames are as they were
constexpr int kInterrupted = 128;     ///< plus the number of the signal, as shells have it

/// What --help prints around the options.
struct HelpText {
  std::string usage;       ///< "Usage: TOOL ...", and below it what the tool does
  std::string exit_codes;  ///< "0 done; 1 failed; ..."
  bool needs_arguments = true;
};

/// An option with a text as its value, whose default is what \p target holds.
boost::program_options::typed_value<std::string>* textOption(std::string& target, const char* name);

/// Adds --force. \param overwrite whether it was given
void addForceOption(boost::program_options::options_description& options, bool& overwrite);

/// Adds --events, --image and --exposure.
void addTopicOptions(boost::program_options::options_description& options, TopicNames& topics);

/// The topics of a recording: those that were named, else the only ones of their types, of which a
/// line on stderr tells.
/// \param name of the recording, for messages
/// \throws BagError naming what is missing and what is there
TopicNames topicsIn(const MessageSource& recording, const TopicNames& named,
                    const std::string& name);

/// Reads the command line; answers --help, which \p options must have.
/// \param words those that are no options, in order; nullptr when the tool takes none
/// \return the values, for notify(); nothing when help was asked for and given
/// \throws boost::program_options::error for no arguments at all, an unknown or incomplete option,
/// a
///         word where none is taken, an empty value (of a shell variable that is not set, say)
std::optional<boost::program_options::variables_map> readCommandLine(
    int argc, char** argv, const boost::program_options::options_description& options,
    const HelpText& text, std::vector<std::string>* words);

/// Separates recordings from name:=value.
void sortWords(const std::vector<std::string>& words, std::vector<std::string>& recordings,
               std::vector<std::string>& overrides);

/// The same for a tool that cannot do without a recording.
/// \throws boost::program_options::error for none
void requireRecordings(const std::vector<std::string>& words, std::vector<std::string>& recordings,
                       std::vector<std::string>& overrides);

/// \throws std::runtime_error when \p path exists and is not to be replaced, or is a directory
void requireFree(const std::string& path, bool overwrite);

/// \throws std::runtime_error when \p output is one of the inputs
void refuseInput(const std::string& output, const std::vector<std::string>& inputs);

/// \param config YAML file, or empty: the overrides alone
/// \throws ParameterError
LoadedParameters loadParameters(const std::string& config,
                                const std::vector<std::string>& overrides);

/// Parameters for a recording that may contain some of them itself: biases become thresholds unless
/// those are given, and measured exposures are used as they are.
/// \throws ParameterError
LoadedParameters loadParametersFor(const MessageSource& recording, const std::string& config,
                                   std::vector<std::string> overrides);

void printWarnings(const LoadedParameters& parameters);

/// The damaged places of a recording, the first ten of them.
void printDamage(const std::string& path, const std::vector<BagDamage>& damage);

/// \param messages that were left out because they contradict themselves
void printMalformed(std::uint64_t messages);

/// Does a tool's work and says why it failed, also when standard output could not be written.
/// \return what \p work returns, or kFailed
int runTool(const std::string& name, const std::function<int()>& work);

}  // namespace tools
}  // namespace fast_edi
