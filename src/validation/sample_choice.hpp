/// \file
/// Which pairs of frames the estimate of the exposures works on.
#pragma once

#include <cstdint>
#include <vector>

#include "survey/recording_survey.hpp"
#include "survey/timing_sample.hpp"

namespace fast_edi {

/// Pairs of consecutive frames with many events, spread over the recording, away from holes.
/// \param centre_ns, range_ns shifts that will be tried: events are asked for as far around
std::vector<SampleRequest> chooseSamples(const RecordingSurvey& survey, std::int64_t centre_ns,
                                         std::int64_t range_ns);

}  // namespace fast_edi
