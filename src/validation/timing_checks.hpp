/// \file
/// From the estimate of the exposures to findings and values to be set.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "survey/finding.hpp"
#include "survey/recording_survey.hpp"
#include "survey/timing_estimate.hpp"
#include "validation/coverage_checks.hpp"

namespace fast_edi {

struct TimingVerdict {
  std::vector<Finding> findings;
  std::vector<std::string> notes;  ///< what was measured, and what cannot be told
  ParameterProposal proposal;
};

/// Stamps mean start, mid or end when the shift lies within 10 % of the exposure of one of them;
/// else it is an offset.
/// \param by_events where events come during exposures only: then these count
TimingVerdict judgeTiming(const RecordingSurvey& survey, const TimingEstimate& estimate,
                          const std::optional<ExposuresByEvents>& by_events);

}  // namespace fast_edi
