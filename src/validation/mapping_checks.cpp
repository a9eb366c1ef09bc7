#include "validation/mapping_checks.hpp"

#include <cmath>
#include <string>

namespace fast_edi {
namespace {

/// Events that a column and a row have at least on average before an empty one says anything.
constexpr double kEnoughPerLine = 20.0;

bool exchangesAxes(EventOrientation orientation) {
  constexpr SensorSize kOblong{2, 1};
  return EventMapping{EventPolarity::kNormal, orientation}.apply(kOblong) != kOblong;
}

/// Nothing at 0, and something one pixel beyond what the frames have.
bool countFromOne(const EventStatistics& events, SensorSize frame) {
  const auto inside = static_cast<double>(events.on() + events.off());
  const double per_line = inside / std::max(events.size().width, events.size().height);
  return per_line >= kEnoughPerLine && events.inColumn(0) == 0 && events.inRow(0) == 0 &&
         events.largestX() <= frame.width && events.largestY() <= frame.height &&
         (events.largestX() == frame.width || events.largestY() == frame.height);
}

Finding orientationFinding(const RecordingSurvey& survey, const TimingEstimate& estimate,
                           const EventMapping& all) {
  const std::string word = toString(all.orientation);
  Finding finding{"orientation", "events and frames with the same axes",
                  textOf("they fit when the events are turned by %s (correlation %.2f)",
                         toString(estimate.mapping.orientation), std::abs(estimate.correlation)),
                  "event_orientation: " + word};
  // The arrays' size shows which axis is which.
  const SensorSize size = survey.statistics()->size();
  const SensorSize frame = survey.frames().frames().front().size;
  if (estimate.mapping.apply(size) != frame) {
    finding.set =
        exchangesAxes(estimate.mapping.orientation)
            ? "convert the recording with x and y of the events exchanged: "
              "event_orientation cannot do it, because the arrays state the frames' width "
              "and height"
            : "convert the recording with arrays of the frames' width and height";
  }
  return finding;
}

}  // namespace

EventMapping combined(const EventMapping& first, const EventMapping& second) {
  // Corners of an oblong sensor distinguish all eight.
  constexpr SensorSize kSize{3, 2};
  const Event corner{0, 0, 0, true};
  const Event side{1, 0, 0, true};
  const auto both = [&](const Event& event) {
    return second.apply(first.apply(event, kSize), first.apply(kSize));
  };
  EventMapping result;
  result.polarity =
      first.polarity == second.polarity ? EventPolarity::kNormal : EventPolarity::kInverted;
  for (const auto& [word, orientation] : kEventOrientations) {
    static_cast<void>(word);
    const EventMapping trial{result.polarity, orientation};
    const auto same = [&](const Event& event) {
      const Event a = trial.apply(event, kSize);
      const Event b = both(event);
      return a.x == b.x && a.y == b.y;
    };
    if (trial.apply(kSize) == second.apply(first.apply(kSize)) && same(corner) && same(side)) {
      result.orientation = orientation;
    }
  }
  return result;
}

std::vector<Finding> checkMapping(const RecordingSurvey& survey, const TimingEstimate& estimate,
                                  const EventMapping& given) {
  std::vector<Finding> findings;
  if (survey.statistics() == nullptr || survey.frames().frames().empty()) {
    return findings;
  }
  const EventMapping all = combined(given, estimate.mapping);
  if (estimate.mapping.orientation != EventOrientation::kNormal) {
    findings.push_back(orientationFinding(survey, estimate, all));
  }
  if (estimate.mapping.polarity == EventPolarity::kInverted) {
    findings.push_back({"polarity-inverted", "ON events where frames brighten",
                        textOf("OFF events there (correlation %.2f)", estimate.correlation),
                        all.polarity == EventPolarity::kInverted ? "event_polarity: inverted"
                                                                 : "event_polarity: normal"});
  }
  if (countFromOne(*survey.statistics(), survey.frames().frames().front().size)) {
    findings.push_back(
        {"coordinates-from-1", "columns and rows counted from 0",
         textOf("no event in column 0 and row 0, and some in column %d or row %d",
                survey.frames().frames().front().size.width,
                survey.frames().frames().front().size.height),
         "convert the recording with 1 less in x and y: there is no parameter for it"});
  }
  return findings;
}

}  // namespace fast_edi
