/// \file
/// Which frame a tuning begins with.
#pragma once

#include <cstddef>
#include <cstdint>

#include "survey/recording_survey.hpp"

namespace fast_edi {

/// The frame with most events during its exposure: much to deblur, and much to see. Where exposures
/// are not known, those within half a period of its stamp count.
/// \param survey finished
/// \param time_offset_ns event time minus frame time
/// \return 0 without frames or events
std::size_t busiestFrame(const RecordingSurvey& survey, std::int64_t time_offset_ns);

}  // namespace fast_edi
