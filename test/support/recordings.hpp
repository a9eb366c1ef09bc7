/// \file
/// Recordings that tests run on: the package's own, and real ones where there are any.
#pragma once

#include <string>
#include <vector>

namespace fast_edi::testing {

struct NamedRecording {
  std::string name;
  std::string path;
  std::string parameters;  ///< overrides that it needs beside cfg/davis346.yaml
  int frames = 0;
  std::vector<std::string> topics;
};

/// `bags/demo.bag`, and the recordings in the folder that the environment variable
/// FAST_EDI_RECORDINGS names. Prints it when that is not set.
/// \throws std::runtime_error when a file of that folder is missing
std::vector<NamedRecording> recordings();

}  // namespace fast_edi::testing
