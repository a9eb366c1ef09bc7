/// \file
/// What `tune` was asked for.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "fast_edi/bags/topic_names.hpp"

namespace fast_edi::tune {

struct Arguments {
  std::vector<std::string> recordings;
  std::string config;
  std::vector<std::string> overrides;
  TopicNames topics;
  std::optional<std::size_t> frame;
  std::string save = "tuned.yaml";
  std::string screenshot;
  bool as_given = false;
  bool overwrite = false;
};

/// \return false when help was asked for and given
/// \throws boost::program_options::error
bool parseArguments(int argc, char** argv, Arguments& arguments);

}  // namespace fast_edi::tune
