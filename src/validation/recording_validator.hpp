/// \file
/// A recording in, findings out. Two passes: the first gathers what the checks need and picks pairs
/// of frames, the second takes these with their events out of the recording.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "survey/finding.hpp"
#include "survey/recording_survey.hpp"
#include "survey/timing_estimate.hpp"
#include "survey/timing_sample.hpp"
#include "validation/coverage_checks.hpp"
#include "validation/frame_outcomes.hpp"

namespace fast_edi {

struct ValidationReport {
  DeblurCounters counters;  ///< what became of the frames, with the parameters as given
  std::string outcomes;     ///< the same for people
  std::vector<Finding> findings;
  std::vector<std::string> notes;
  ParameterProposal proposal;
  TimingEstimate timing;
};

class RecordingValidator {
 public:
  /// \param pipeline with which the frames' outcomes are counted
  RecordingValidator(const AssumedParameters& parameters, const DeblurParameters& pipeline);

  /// Messages in the order of their record times, in both passes the same ones.
  void addEvents(const WireEvents& events, SensorSize size, std::uint32_t sequence,
                 std::int64_t record_ns);
  void addFrame(const FrameMessage& frame);
  void addExposure(std::int32_t exposure_us, std::int64_t record_ns);
  /// Ends the first pass. \return false when a second one would find nothing more
  bool endSurvey();
  /// \param progress of the estimate
  ValidationReport finish(std::function<void(int done, int total)> progress);

  const RecordingSurvey& survey() const { return survey_; }

 private:
  EventMapping mapping_;              ///< as given
  std::vector<std::uint8_t> mapped_;  ///< an array's records
  RecordingSurvey survey_;
  FrameOutcomes outcomes_;
  TimingSearch search_;
  std::unique_ptr<TimingSampler> sampler_;  ///< during the second pass
  std::size_t sampled_frames_ = 0;
  std::optional<ExposuresByEvents> by_events_;
  std::string reason_ = "no pair of frames has events around it";
};

}  // namespace fast_edi
