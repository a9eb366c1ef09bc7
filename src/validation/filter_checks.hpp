/// \file
/// Findings about events that were filtered out, and pixels that should be.
///
/// Background-activity filter: an event passes when one of its eight neighbours had an event within
/// the filter's time. Times to the neighbours' last event then break off at that time, while they
/// fall off smoothly without a filter: the count in the 3/8 of an octave before an edge is compared
/// with the 3/8 behind it, and this fall with those nearby.
///
/// Refractory filter: times between events of one pixel set in at the filter's time all at once.
/// Pixels' own refractory periods are 3 to 100 us, the filter's steps 250 us. A filter shorter than
/// the times that the scene gives removes nothing and is not seen.
///
/// Polarity filters: one polarity is (almost) missing. Short of that, numbers of ON and OFF that
/// differ by more than a factor of two hint at a wrong bias: levels come back in the long run, so
/// N_on C_on = N_off C_off.
///
/// A skip filter leaves no trace in times; it makes each event stand for a larger step, see
/// timing_checks.hpp.
#pragma once

#include <optional>
#include <vector>

#include "survey/event_statistics.hpp"
#include "survey/finding.hpp"

namespace fast_edi {

/// Time at which times to neighbours' events break off, if they do [ns].
/// \param longest_ns not looked for beyond
std::optional<double> backgroundActivityEdgeNs(const TimeHistogram& neighbour_times,
                                               double longest_ns);
/// Time at which times between a pixel's events set in, if they do so at once [ns].
std::optional<double> refractoryEdgeNs(const TimeHistogram& pixel_times);

/// True when there are hardly any events of one polarity.
bool polarityIsMissing(const EventStatistics& statistics);

/// \param stretch_ns for how long at a time events come without a pause: times near that are cut
/// off
/// \param origin in whose words advice is given
std::vector<Finding> checkFilters(const EventStatistics& statistics, double stretch_ns,
                                  RecordingOrigin origin);

}  // namespace fast_edi
