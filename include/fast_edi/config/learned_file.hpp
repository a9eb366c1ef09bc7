/// \file
/// What was learned from a recording, as a YAML file of parameters: where the next run starts.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fast_edi/base/contrast_threshold.hpp"

namespace fast_edi {

/// The lines of such a file.
/// \param thresholds [natural log]
std::string learnedYaml(const ContrastThresholds& thresholds, std::int64_t event_delay_ns);

/// What such a file holds, for applyOverrides().
/// \throws ParameterError naming the file and what is wrong in it
std::vector<std::string> learnedOverrides(const std::string& path);

/// Gets its name when it is complete; until then, and for what a crash leaves of it, it is
/// `PATH.active`.
class LearnedFile {
 public:
  /// Makes sure that the file can be written, before any work is done.
  /// An existing file will be replaced.
  /// \throws std::runtime_error naming the file and the reason
  explicit LearnedFile(const std::string& path);
  /// Leaves nothing unless write() was called.
  ~LearnedFile();
  LearnedFile(const LearnedFile&) = delete;
  LearnedFile& operator=(const LearnedFile&) = delete;

  /// \throws std::runtime_error naming the file and the reason
  void write(const ContrastThresholds& thresholds, std::int64_t event_delay_ns);

 private:
  const std::string path_;
  const std::string active_path_;
};

}  // namespace fast_edi
