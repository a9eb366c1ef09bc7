/// \file
/// Findings about the exposure topic by itself.
#pragma once

#include <vector>

#include "fast_edi/validation/finding.hpp"
#include "fast_edi/validation/recording_survey.hpp"

namespace fast_edi {

std::vector<Finding> checkExposures(const RecordingSurvey& survey);

}  // namespace fast_edi
