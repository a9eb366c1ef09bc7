/// \file
/// What was learned from a recording, as a YAML file of parameters: where the next run starts.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fast_edi/base/contrast_threshold.hpp"
#include "fast_edi/config/parameter_file.hpp"

namespace fast_edi {

/// The lines of such a file.
/// \param thresholds [natural log]
std::string learnedYaml(const ContrastThresholds& thresholds, std::int64_t event_delay_ns);

/// What such a file holds, for applyOverrides().
/// \throws ParameterError naming the file and what is wrong in it
std::vector<std::string> learnedOverrides(const std::string& path);

class LearnedFile {
 public:
  /// Makes sure that the file can be written, before any work is done; see ParameterFile.
  /// \throws std::runtime_error naming the file and the reason
  explicit LearnedFile(const std::string& path) : file_(path) {}

  /// \throws std::runtime_error naming the file and the reason
  void write(const ContrastThresholds& thresholds, std::int64_t event_delay_ns);

 private:
  ParameterFile file_;
};

}  // namespace fast_edi
