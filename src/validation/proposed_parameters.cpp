#include "validation/proposed_parameters.hpp"

#include <cstdint>

#include "fast_edi/base/number_text.hpp"

namespace fast_edi {
namespace {

/// More digits would say more than the estimate knows.
constexpr int kThresholdDecimals = 3;

}  // namespace

std::vector<std::string> proposedOverrides(const ParameterProposal& proposal,
                                           const RecordingSurvey& survey) {
  std::vector<std::string> overrides = {
      "stamp_reference:=" + instantName(proposal.stamp_reference),
      "time_offset_us:=" + std::to_string(proposal.time_offset_us),
      std::string("event_polarity:=") +
          (proposal.event_mapping.polarity == EventPolarity::kInverted ? "inverted" : "normal"),
      std::string("event_orientation:=") + toString(proposal.event_mapping.orientation)};
  const std::int64_t assumed_us = survey.parameters().exposure_time_ns / kNanosecondsPerMicrosecond;
  if (proposal.exposure_time_us > 0 && proposal.exposure_time_us != assumed_us) {
    overrides.push_back("exposure_time_us:=" + std::to_string(proposal.exposure_time_us));
    if (!survey.frames().exposuresUs().empty()) {
      overrides.emplace_back("exposure_source:=parameter");
    }
  }
  if (proposal.thresholds) {
    overrides.push_back("contrast_threshold_on:=" +
                        fixedText(proposal.thresholds->on, kThresholdDecimals));
    overrides.push_back("contrast_threshold_off:=" +
                        fixedText(proposal.thresholds->off, kThresholdDecimals));
  }
  return overrides;
}

}  // namespace fast_edi
