/// \file
/// What validate_bag proposes, as parameters.
#pragma once

#include <string>
#include <vector>

#include "survey/finding.hpp"
#include "survey/recording_survey.hpp"

namespace fast_edi {

/// `name:=value` for each value that the recording determines, for applyOverrides(). An exposure
/// other than that of the survey's parameters comes before recorded ones.
/// \param survey that \p proposal was made from
std::vector<std::string> proposedOverrides(const ParameterProposal& proposal,
                                           const RecordingSurvey& survey);

}  // namespace fast_edi
