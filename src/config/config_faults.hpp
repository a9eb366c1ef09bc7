/// \file
/// The faults of a configuration, all of them before any is reported.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <yaml-cpp/yaml.h>

namespace fast_edi {

class ConfigFaults {
 public:
  /// \param file name that begins each line of text(); may be empty
  explicit ConfigFaults(std::string file = {}) : file_(std::move(file)) {}

  /// \param where the node at fault: its line is named when it comes from a file, and that it was
  /// given as key:=value when it does not although there is a file
  void add(const YAML::Node& where, const std::string& text);

  /// Adds the lines of \p others.
  void append(const ConfigFaults& others);

  bool empty() const { return lines_.empty(); }
  std::size_t size() const { return lines_.size(); }
  /// One line for each fault.
  std::string text() const;

 private:
  std::string file_;
  std::vector<std::string> lines_;
};

}  // namespace fast_edi
