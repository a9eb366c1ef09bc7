/// \file
/// Parameters as far as they have been read, key by key.
#pragma once

#include <set>
#include <string>

#include "fast_edi/config/parameters_from_yaml.hpp"

namespace fast_edi {

struct ParameterDraft {
  /// Where relative paths start.
  std::string base_directory;
  LoadedParameters loaded;
  BiasConfiguration biases;
  std::string response_file;
  double response_offset_dn = 0.0;

  /// Keys that the configuration has, by their first spelling, e.g. "biases/OnBn_fine".
  std::set<std::string> given;
  /// Those of them for which a fault was reported: nothing else is to be said about them.
  std::set<std::string> faulty;

  bool has(const std::string& key) const { return given.count(key) != 0; }
  bool isFaulty(const std::string& key) const { return faulty.count(key) != 0; }
};

}  // namespace fast_edi
