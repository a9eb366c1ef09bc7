#include "validation/coverage_checks.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "validation/advice.hpp"

namespace fast_edi {
namespace {

constexpr std::size_t kLeastFrames = 4;
/// Pauses are alike when they differ by less than this part from their median ...
constexpr double kAlike = 0.3;
/// ... and belong to the frames when that many of all frames have one.
constexpr double kMostFrames = 0.7;
constexpr double kPausesPerFrame = 1.4;
/// A hole is a pause in which by the rate on both sides at least that many events were due.
constexpr double kMissedEvents = 100.0;
constexpr std::int64_t kSide_ns = 5 * kNanosecondsPerMillisecond;
constexpr double kTolerablyUncovered = 0.05;
constexpr std::size_t kTolerablyUncoveredFrames = 2;  ///< at the ends of each recording

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

std::vector<const LoggedFrame*> framesOf(const RecordingSurvey& survey, const EventEpoch& epoch) {
  std::vector<const LoggedFrame*> frames;
  const auto index = static_cast<std::size_t>(&epoch - survey.timeline().epochs().data());
  for (const LoggedFrame& frame : survey.frames().frames()) {
    const std::int64_t t_ns = frame.stamp_ns + survey.parameters().time_offset_ns;
    if (frame.epoch == index && t_ns >= epoch.first_ns && t_ns <= epoch.last_ns) {
      frames.push_back(&frame);
    }
  }
  return frames;
}

bool overlaps(const ExposureInterval& a, const ExposureInterval& b) {
  return a.start_ns < b.end_ns && b.start_ns < a.end_ns;
}

}  // namespace

std::optional<ExposuresByEvents> exposuresByEvents(const RecordingSurvey& survey) {
  const EventEpoch* epoch = survey.timeline().longestEpoch();
  if (epoch == nullptr || epoch->pauses.size() < kLeastFrames - 1) {
    return std::nullopt;
  }
  const std::vector<const LoggedFrame*> frames = framesOf(survey, *epoch);
  if (frames.size() < kLeastFrames) {
    return std::nullopt;
  }
  std::vector<double> lengths;
  for (const ExposureInterval& pause : epoch->pauses) {
    lengths.push_back(static_cast<double>(pause.length()));
  }
  ExposuresByEvents seen;
  seen.pause_ns = median(lengths);
  std::vector<ExposureInterval> pauses;
  std::copy_if(epoch->pauses.begin(), epoch->pauses.end(), std::back_inserter(pauses),
               [&](const ExposureInterval& pause) {
                 return std::abs(static_cast<double>(pause.length()) - seen.pause_ns) <
                        kAlike * seen.pause_ns;
               });
  const auto count = static_cast<double>(frames.size() - 1);
  if (static_cast<double>(pauses.size()) < kMostFrames * count ||
      static_cast<double>(epoch->pauses.size()) > kPausesPerFrame * count + 2.0) {
    return std::nullopt;
  }
  // One busy time for each frame: between consecutive pauses about a period apart.
  const auto period_ns = static_cast<double>(survey.frames().periodNs());
  std::vector<double> busy;
  std::vector<double> shifts;
  for (std::size_t i = 1; i < pauses.size(); ++i) {
    const ExposureInterval exposure{pauses[i - 1].end_ns, pauses[i].start_ns};
    const double distance = static_cast<double>(pauses[i].start_ns - pauses[i - 1].start_ns);
    if (std::abs(distance - period_ns) > kAlike * period_ns) {
      continue;
    }
    const std::int64_t middle_ns = exposure.start_ns + exposure.length() / 2;
    const auto nearest = std::min_element(
        frames.begin(), frames.end(), [middle_ns](const LoggedFrame* a, const LoggedFrame* b) {
          return std::abs(a->stamp_ns - middle_ns) < std::abs(b->stamp_ns - middle_ns);
        });
    busy.push_back(static_cast<double>(exposure.length()));
    shifts.push_back(static_cast<double>(middle_ns - (*nearest)->stamp_ns));
  }
  if (busy.size() + 1 < kLeastFrames - 1) {
    return std::nullopt;
  }
  seen.length_ns = median(busy);
  seen.shift_ns = median(shifts);
  std::vector<double> deviations;
  for (const double shift : shifts) {
    deviations.push_back(std::abs(shift - seen.shift_ns));
  }
  seen.sigma_ns = 1.5 * median(deviations) / std::sqrt(static_cast<double>(shifts.size()));
  return seen;
}

std::vector<ExposureInterval> eventHoles(const RecordingSurvey& survey) {
  std::vector<ExposureInterval> holes;
  const auto between = exposuresByEvents(survey);
  for (const EventEpoch& epoch : survey.timeline().epochs()) {
    for (const ExposureInterval& pause : epoch.pauses) {
      const auto length = static_cast<double>(pause.length());
      if (between && length < (1.0 + kAlike) * between->pause_ns) {
        continue;
      }
      // To the millisecond: the bins that the pause begins and ends in count to the sides.
      const auto side = [&](std::int64_t from, std::int64_t to) {
        return static_cast<double>(epoch.count({from, to}));
      };
      const double before = side(pause.start_ns - kSide_ns, pause.start_ns + EventEpoch::kBin_ns);
      const double behind = side(pause.end_ns, pause.end_ns + kSide_ns + EventEpoch::kBin_ns);
      if (std::min(before, behind) * length / static_cast<double>(kSide_ns) >= kMissedEvents) {
        holes.push_back(pause);
      }
    }
  }
  return holes;
}

std::vector<Finding> checkCoverage(const RecordingSurvey& survey) {
  std::vector<Finding> findings;
  const auto between = exposuresByEvents(survey);
  if (between) {
    findings.push_back(
        {"no-events-between-exposures", "events all the time",
         textOf("events for %.2f ms, then none for %.2f ms, frame by frame",
                between->length_ns / kMs, between->pause_ns / kMs),
         adviceFor(Remedy::kEventsBetween, survey.parameters().origin) +
             "; frames can be deblurred all the same, "
             "but thresholds cannot be learned: refine_contrast: false, refine_delay: false"});
  }
  const std::vector<ExposureInterval> holes = eventHoles(survey);
  if (!holes.empty()) {
    const auto longest =
        *std::max_element(holes.begin(), holes.end(),
                          [](const auto& a, const auto& b) { return a.length() < b.length(); });
    const EventEpoch* epoch = survey.timeline().longestEpoch();
    findings.push_back({"event-holes", "no pause amid many events",
                        textOf("%zu, the longest %.1f ms, at %.3f s of the recording", holes.size(),
                               static_cast<double>(longest.length()) / kMs,
                               static_cast<double>(longest.start_ns - epoch->first_ns) * 1e-9),
                        adviceFor(Remedy::kFewerLosses, survey.parameters().origin) +
                            "; frames there are deblurred wrongly"});
  }
  std::size_t known = 0;
  std::size_t uncovered = 0;
  for (const LoggedFrame& frame : survey.frames().frames()) {
    const auto exposure = survey.assumedExposure(frame);
    if (!exposure) {
      continue;
    }
    ++known;
    const auto& epochs = survey.timeline().epochs();
    const bool inside = std::any_of(epochs.begin(), epochs.end(), [&](const EventEpoch& epoch) {
      return epoch.contains(
          {exposure->start_ns + EventEpoch::kBin_ns, exposure->end_ns - EventEpoch::kBin_ns});
    });
    const bool holed = std::any_of(holes.begin(), holes.end(), [&](const ExposureInterval& hole) {
      return overlaps(hole, *exposure);
    });
    uncovered += inside && !holed ? 0 : 1;
  }
  if (uncovered > kTolerablyUncoveredFrames &&
      static_cast<double>(uncovered) > kTolerablyUncovered * static_cast<double>(known)) {
    findings.push_back(
        {"exposures-uncovered", "events throughout each exposure",
         textOf("%zu of %zu exposures (%.0f %%) are not covered", uncovered, known,
                100.0 * static_cast<double>(uncovered) / static_cast<double>(known)),
         "stamp_reference and time_offset_us as proposed below; else record events and frames "
         "together"});
  }
  return findings;
}

}  // namespace fast_edi
