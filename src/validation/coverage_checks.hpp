/// \file
/// Findings about times without events: holes, exposures that no events cover, drivers that send
/// events during exposures only.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "survey/finding.hpp"
#include "survey/recording_survey.hpp"

namespace fast_edi {

/// Exposures as seen by the times that have events, where events come during exposures only.
struct ExposuresByEvents {
  double pause_ns = 0.0;   ///< median length of the times without events
  double length_ns = 0.0;  ///< median length of the times with events
  double shift_ns = 0.0;   ///< their middle - frame stamp, median
  double sigma_ns = 0.0;   ///< of both
};

/// Empty unless there is about one like pause from frame to frame.
std::optional<ExposuresByEvents> exposuresByEvents(const RecordingSurvey& survey);

/// Pauses of the event stream amid many events: some were lost. Pauses between exposures are none
/// where exposuresByEvents() has found that they belong there.
std::vector<ExposureInterval> eventHoles(const RecordingSurvey& survey);

std::vector<Finding> checkCoverage(const RecordingSurvey& survey);

}  // namespace fast_edi
