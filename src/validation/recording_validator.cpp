#include "validation/recording_validator.hpp"

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "validation/coverage_checks.hpp"
#include "validation/exposure_checks.hpp"
#include "validation/filter_checks.hpp"
#include "validation/mapping_checks.hpp"
#include "validation/sample_choice.hpp"
#include "validation/stream_checks.hpp"
#include "validation/timing_checks.hpp"

namespace fast_edi {
namespace {

/// Shifts that are tried: this far, and as far as stamps at the start or the end of the longest
/// exposure need.
constexpr std::int64_t kLeastRange_ns = 50 * kNanosecondsPerMillisecond;
constexpr std::int64_t kMargin_ns = 15 * kNanosecondsPerMillisecond;
/// How well the rough offset is known.
constexpr std::int64_t kRoughRange_ns = 150 * kNanosecondsPerMillisecond;

void append(std::vector<Finding>& findings, std::vector<Finding> more) {
  std::move(more.begin(), more.end(), std::back_inserter(findings));
}

}  // namespace

RecordingValidator::RecordingValidator(const AssumedParameters& parameters,
                                       const DeblurParameters& pipeline)
    : mapping_(pipeline.event_mapping), survey_(parameters), outcomes_(pipeline) {}

void RecordingValidator::addEvents(const WireEvents& events, SensorSize size,
                                   std::uint32_t sequence, std::int64_t record_ns) {
  WireEvents mapped = events;
  if (!mapping_.isIdentity()) {
    mapped_.assign(events.data, events.data + events.count * kWireEventBytes);
    mapping_.apply(mapped_.data(), events.count, size);
    mapped.data = mapped_.data();
  }
  if (sampler_) {
    sampler_->addEvents(mapped, mapping_.apply(size));
  } else {
    survey_.addEvents(mapped, mapping_.apply(size), sequence, record_ns);
    outcomes_.addEvents(events, size, sequence, record_ns);
  }
}

void RecordingValidator::addFrame(const FrameMessage& frame) {
  if (!sampler_) {
    survey_.addFrame(frame);
    outcomes_.addFrame(frame);
    return;
  }
  const std::vector<LoggedFrame>& frames = survey_.frames().frames();
  if (sampled_frames_ < frames.size()) {
    const LoggedFrame& logged = frames[sampled_frames_];
    SampledFrame sampled;
    sampled.stamp_ns = logged.stamp_ns;
    sampled.length_ns = survey_.assumedLengthNs(logged);
    sampled.previous_length_ns =
        sampled.length_ns == logged.length_ns ? logged.previous_length_ns : 0;
    sampler_->addFrame(sampled_frames_, sampled, frame.pixels);
  }
  ++sampled_frames_;
}

void RecordingValidator::addExposure(std::int32_t exposure_us, std::int64_t record_ns) {
  if (!sampler_) {
    survey_.addExposure(exposure_us, record_ns);
    outcomes_.addExposure(exposure_us, record_ns);
  }
}

bool RecordingValidator::endSurvey() {
  survey_.finish();
  outcomes_.finish();
  by_events_ = exposuresByEvents(survey_);
  if (survey_.statistics() == nullptr || by_events_) {
    return false;
  }
  if (polarityIsMissing(*survey_.statistics())) {
    reason_ = "one polarity is missing";
    return false;
  }
  search_.thresholds = survey_.parameters().thresholds;
  std::int64_t longest_ns = 0;
  for (const LoggedFrame& frame : survey_.frames().frames()) {
    longest_ns = std::max(longest_ns, survey_.assumedLengthNs(frame));
  }
  if (longest_ns == 0) {
    longest_ns = survey_.frames().periodNs();
  }
  search_.range_ns = std::max(kLeastRange_ns, longest_ns / 2 + kMargin_ns);
  if (std::abs(survey_.roughClockOffsetNs()) > RecordingSurvey::kLargestDelay_ns) {
    search_.centre_ns = survey_.roughClockOffsetNs();
    search_.range_ns = std::max(search_.range_ns, kRoughRange_ns);
  }
  const auto requests = chooseSamples(survey_, search_.centre_ns, search_.range_ns);
  if (requests.empty()) {
    return false;
  }
  sampler_ = std::make_unique<TimingSampler>(survey_.statistics()->size(), requests);
  return true;
}

ValidationReport RecordingValidator::finish(std::function<void(int done, int total)> progress) {
  ValidationReport report;
  report.counters = outcomes_.counters();
  report.outcomes = outcomes_.describe();
  append(report.findings, checkStreams(survey_));
  if (survey_.statistics() != nullptr) {
    const EventEpoch& epoch = *survey_.timeline().longestEpoch();
    append(report.findings,
           checkFilters(*survey_.statistics(),
                        by_events_ ? by_events_->length_ns
                                   : static_cast<double>(epoch.last_ns - epoch.first_ns),
                        survey_.parameters().origin));
  }
  append(report.findings, checkCoverage(survey_));
  append(report.findings, checkExposures(survey_));
  report.timing.reason = reason_;
  if (sampler_) {
    search_.progress = std::move(progress);
    const SampleGrid grid = sampler_->grid();
    std::vector<TimingSample> samples = sampler_->take();
    report.timing = estimateTiming(samples, grid, search_);
  }
  TimingVerdict verdict = judgeTiming(survey_, report.timing, by_events_);
  append(report.findings, checkMapping(survey_, report.timing, mapping_));
  verdict.proposal.given_mapping = mapping_;
  verdict.proposal.event_mapping = combined(mapping_, report.timing.mapping);
  append(report.findings, std::move(verdict.findings));
  report.notes = std::move(verdict.notes);
  report.proposal = verdict.proposal;
  return report;
}

}  // namespace fast_edi
