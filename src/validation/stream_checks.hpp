/// \file
/// Findings about messages, sizes, encodings, stamps and clocks.
#pragma once

#include <vector>

#include "survey/finding.hpp"
#include "survey/recording_survey.hpp"

namespace fast_edi {

std::vector<Finding> checkStreams(const RecordingSurvey& survey);

}  // namespace fast_edi
