/// \file
/// Findings about events whose pixels or polarities are not those of the frames.
#pragma once

#include <vector>

#include "fast_edi/events/event_mapping.hpp"
#include "survey/finding.hpp"
#include "survey/recording_survey.hpp"
#include "survey/timing_estimate.hpp"

namespace fast_edi {

/// The one mapping that does what \p first and then \p second do.
EventMapping combined(const EventMapping& first, const EventMapping& second);

/// \param given by the parameters; what the survey and the estimate saw were events so mapped
std::vector<Finding> checkMapping(const RecordingSurvey& survey, const TimingEstimate& estimate,
                                  const EventMapping& given);

}  // namespace fast_edi
