#include "tuning/first_frame.hpp"

#include <algorithm>

namespace fast_edi {

std::size_t busiestFrame(const RecordingSurvey& survey, std::int64_t time_offset_ns) {
  const std::vector<LoggedFrame>& frames = survey.frames().frames();
  const std::vector<EventEpoch>& epochs = survey.timeline().epochs();
  std::size_t busiest = 0;
  std::uint64_t most_events = 0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (!frames[i].supported || frames[i].epoch >= epochs.size()) {
      continue;
    }
    const std::int64_t assumed_ns = survey.assumedLengthNs(frames[i]);
    const std::int64_t half_ns = (assumed_ns > 0 ? assumed_ns : survey.frames().periodNs()) / 2;
    const std::int64_t middle_ns = frames[i].stamp_ns + time_offset_ns;
    const std::uint64_t events =
        epochs[frames[i].epoch].count({middle_ns - half_ns, middle_ns + half_ns});
    if (events > most_events) {
      most_events = events;
      busiest = i;
    }
  }
  return busiest;
}

}  // namespace fast_edi
