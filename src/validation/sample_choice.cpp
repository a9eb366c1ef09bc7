#include "validation/sample_choice.hpp"

#include <algorithm>
#include <cstddef>

#include "validation/coverage_checks.hpp"

namespace fast_edi {
namespace {

constexpr std::size_t kSamples = 12;
constexpr std::size_t kLeastSamples = 4;
/// Of all samples together, before rows are left out.
constexpr std::uint64_t kMostEvents = 24'000'000;
/// Pairs whose events are cut off by the recording's ends are taken where others are much worse.
constexpr double kWorthCut = 0.3;
constexpr double kLargestGap = 1.6;  ///< between frames, in periods

struct Candidate {
  SampleRequest request;
  double worth = 0.0;
  std::uint64_t events = 0;
};

}  // namespace

std::vector<SampleRequest> chooseSamples(const RecordingSurvey& survey, std::int64_t centre_ns,
                                         std::int64_t range_ns) {
  const EventEpoch* epoch = survey.timeline().longestEpoch();
  if (epoch == nullptr || survey.statistics() == nullptr) {
    return {};
  }
  const auto index = static_cast<std::size_t>(epoch - survey.timeline().epochs().data());
  const std::vector<ExposureInterval> holes = eventHoles(survey);
  const std::vector<LoggedFrame>& frames = survey.frames().frames();
  const auto period_ns = static_cast<double>(survey.frames().periodNs());
  const SensorSize sensor = survey.statistics()->size();
  const SensorSize turned{sensor.height, sensor.width};  // events may have their axes exchanged
  std::vector<Candidate> candidates;
  for (std::size_t i = 0; i + 1 < frames.size(); ++i) {
    const LoggedFrame& first = frames[i];
    const LoggedFrame& second = frames[i + 1];
    const std::int64_t gap_ns = second.stamp_ns - first.stamp_ns;
    if (!first.supported || !second.supported || (first.size != sensor && first.size != turned) ||
        second.size != first.size || first.epoch != index || second.epoch != index || gap_ns <= 0 ||
        static_cast<double>(gap_ns) > kLargestGap * period_ns) {
      continue;
    }
    const ExposureInterval inner{first.stamp_ns + centre_ns - gap_ns / 2,
                                 second.stamp_ns + centre_ns + gap_ns / 2};
    Candidate candidate;
    candidate.request.first_frame = i;
    candidate.request.events = {inner.start_ns - range_ns, inner.end_ns + range_ns};
    const bool holed = std::any_of(holes.begin(), holes.end(), [&](const ExposureInterval& hole) {
      return hole.start_ns < inner.end_ns && inner.start_ns < hole.end_ns;
    });
    candidate.worth = static_cast<double>(epoch->count(inner)) *
                      (epoch->contains(candidate.request.events) ? 1.0 : kWorthCut);
    candidate.events = epoch->count(candidate.request.events);
    if (!holed && candidate.worth > 0.0) {
      candidates.push_back(candidate);
    }
  }
  // The best of each stretch of the recording.
  const std::size_t stretches = std::min(kSamples, candidates.size());
  std::vector<Candidate> best;
  for (std::size_t k = 0; k < stretches; ++k) {
    const auto begin =
        candidates.begin() + static_cast<std::ptrdiff_t>(k * candidates.size() / stretches);
    const auto end =
        candidates.begin() + static_cast<std::ptrdiff_t>((k + 1) * candidates.size() / stretches);
    best.push_back(*std::max_element(
        begin, end, [](const Candidate& a, const Candidate& b) { return a.worth < b.worth; }));
  }
  // Not more than memory should hold.
  std::uint64_t events = 0;
  std::vector<SampleRequest> requests;
  for (const Candidate& candidate : best) {
    events += candidate.events;
    if (events > kMostEvents && requests.size() >= kLeastSamples) {
      break;
    }
    requests.push_back(candidate.request);
  }
  return requests;
}

}  // namespace fast_edi
