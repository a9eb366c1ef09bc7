/// \file
/// Other methods as they are named on a command line.
#pragma once

#include <string>
#include <vector>

namespace fast_edi {

/// "NAME=FILE".
struct NamedFile {
  std::string name;
  std::string file;
};

/// \param option for messages: "--network"
/// \param taken names of the columns so far, to which the new one is added
/// \throws std::invalid_argument without a name or a file, for a name that is taken, and for one
/// that would break a table or a CSV file (|, comma, quotation mark, line break)
NamedFile namedFile(const std::string& option, const std::string& text,
                    std::vector<std::string>& taken);

/// Names of the columns that `evaluate` always has.
std::vector<std::string> methodNames();

/// "OUT.bag" or "OUT.bag:TOPIC". What exists under the whole name has no topic.
struct RecordedTopic {
  std::string recording;
  std::string topic;
};
/// \param topic for a text without one
RecordedTopic recordedTopic(const std::string& text, const std::string& topic);

}  // namespace fast_edi
