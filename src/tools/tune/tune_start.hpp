/// \file
/// What a recording is, and the parameters that tuning starts from.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "fast_edi/bags/topic_names.hpp"
#include "fast_edi/config/parameters_from_yaml.hpp"
#include "tools/tune/tune_arguments.hpp"
#include "tuning/tuning_sliders.hpp"

namespace fast_edi::tune {

struct Start {
  TopicNames topics;
  std::vector<std::string> overrides;      ///< proposals, then those given
  std::vector<std::int32_t> exposures_us;  ///< of all frames; 0: none of its own
  TuningRanges ranges;
  std::int64_t longest_exposure_ns = 0;
  std::size_t busiest_frame = 0;
  LoadedParameters loaded;
};

/// Reads the recording through: its frames, and what validate_bag proposes for it, unless the
/// parameters are to stay as they are given. Says what was proposed.
/// \throws std::runtime_error when it cannot be used
Start startOf(const Arguments& arguments);

}  // namespace fast_edi::tune
