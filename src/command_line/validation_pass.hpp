/// \file
/// A recording of any format read through a RecordingValidator, as `validate_bag` and `tune` do it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fast_edi/bags/message_source.hpp"
#include "fast_edi/bags/topic_names.hpp"
#include "validation/recording_validator.hpp"

namespace fast_edi {
namespace tools {

/// What a recording is compared with.
struct ValidationStart {
  AssumedParameters parameters;
  DeblurParameters pipeline;
};

/// Those of a configuration; warnings are printed. Without a configuration and biases in the
/// recording, thresholds are not given.
/// \throws ParameterError
ValidationStart validationStart(const MessageSource& recording, const std::string& config,
                                std::vector<std::string> overrides);

/// What was wrong with the recording itself.
struct ReadResult {
  std::uint64_t malformed = 0;  ///< messages that contradict themselves, and were not used
  std::vector<BagDamage> damage;
};

/// One pass.
/// \param label of the progress bar
/// \throws RecordingError when it cannot be opened
ReadResult readThrough(const std::vector<std::string>& recordings, const TopicNames& topics,
                       const std::string& label, RecordingValidator& validator);

/// The second pass, if there is to be one, and the report.
/// \pre readThrough() was called
ValidationReport finishValidation(const std::vector<std::string>& recordings,
                                  const TopicNames& topics, RecordingValidator& validator);

}  // namespace tools
}  // namespace fast_edi
