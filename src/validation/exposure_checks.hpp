/// \file
/// Findings about the exposure topic by itself.
#pragma once

#include <vector>

#include "survey/finding.hpp"
#include "survey/recording_survey.hpp"

namespace fast_edi {

std::vector<Finding> checkExposures(const RecordingSurvey& survey);

}  // namespace fast_edi
