/// \file
/// What `evaluate` was asked for.
#pragma once

#include <string>
#include <vector>

#include "dark_channel/dark_channel_method.hpp"
#include "evaluation/evaluation.hpp"
#include "fast_edi/bags/topic_names.hpp"
#include "fast_edi/config/parameters_from_yaml.hpp"
#include "sequences/sequence_sets.hpp"
#include "sequences/sequences.hpp"

namespace fast_edi::evaluate {

struct Arguments {
  std::vector<std::string> recordings;
  std::string config;
  std::string output;
  std::string command;
  TopicNames topics;
  std::string truth_topic;
  ScorerOptions scorer;
  ContrastSearchOptions search;
  std::vector<std::string> overrides;
  std::vector<std::string> columns;   ///< NAME=OUT.bag[:TOPIC]
  std::vector<std::string> networks;  ///< NAME=MODEL.onnx
  std::string network_range = "0:1";
  bool dark_channel = false;
  BlindDeblurringOptions dark_channel_options;
  bool overwrite = false;
  std::string sequences;  ///< name of a set; empty: a recording
  std::vector<std::string> variants;
  std::string photographs = kPhotographFolder;
  int frames = 0;  ///< 0: as many as the set has
  int seeds = kSequenceSeeds;
  double threshold_factor = 1.0;
  int video_images = 0;
};

/// \return false when help was asked for and given
/// \throws boost::program_options::error
bool parseArguments(int argc, char** argv, Arguments& arguments);

/// Of simulated sequences, whose sensor has the thresholds unless they are given.
/// \param more overrides that come before all others
/// \throws ParameterError
LoadedParameters loadParameters(const Arguments& arguments,
                                const std::vector<std::string>& more = {});

/// Of each sequence of the twelve.
int framesOfTwelve(const Arguments& arguments);

}  // namespace fast_edi::evaluate
