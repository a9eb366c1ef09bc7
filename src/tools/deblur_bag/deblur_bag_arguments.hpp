/// \file
/// What `deblur_bag` was asked for.
#pragma once

#include <string>
#include <vector>

#include "fast_edi/bags/topic_names.hpp"

namespace fast_edi::deblur_bag {

/// Empty names: not asked for.
struct Arguments {
  static constexpr int kDefaultFilmRate_hz = 500;

  std::vector<std::string> inputs;
  std::string output;
  std::string output_folder;  ///< each input is a recording of its own
  std::string config;
  std::string compression;
  bool rewrite = false;  ///< no chunk is copied as it is
  TopicNames topics;
  std::vector<std::string> overrides;
  bool overwrite = false;
  std::string video;
  std::string frames;
  std::string trust;
  std::string learned;
  std::string save_learned;
  int film_rate_hz = kDefaultFilmRate_hz;
  int threads = 0;  ///< that work at a time, at least 1 once parsed
};

/// \return false when help was asked for and given
/// \throws boost::program_options::error
bool parseArguments(int argc, char** argv, Arguments& arguments);

}  // namespace fast_edi::deblur_bag
