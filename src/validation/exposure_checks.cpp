#include "validation/exposure_checks.hpp"

#include <vector>

#include "validation/advice.hpp"

namespace fast_edi {
namespace {

/// Messages may be missing for the first and the last frame.
constexpr std::uint64_t kTolerablyUnpaired = 2;

}  // namespace

std::vector<Finding> checkExposures(const RecordingSurvey& survey) {
  std::vector<Finding> findings;
  const FrameLog& log = survey.frames();
  const DeblurCounters& counters = log.counters();
  if (survey.parameters().exposure_from_parameter) {
    return findings;
  }
  if (log.exposuresUs().empty()) {
    if (survey.parameters().exposure_time_ns == 0) {
      findings.push_back({"exposure-missing", "an exposure message for each frame, or a parameter",
                          "neither",
                          adviceFor(Remedy::kGivenExposure, survey.parameters().origin)});
    }
    return findings;
  }
  if (counters.exposures_refused > 0) {
    findings.push_back({"exposure-refused", "exposures above 0 us, up to 1 s",
                        textOf("%llu of %zu messages outside", count(counters.exposures_refused),
                               log.exposuresUs().size()),
                        "exposure_source: parameter and exposure_time_us as proposed below"});
  }
  const std::uint64_t unpaired = counters.exposures_missing + counters.exposures_surplus;
  if (unpaired > kTolerablyUnpaired) {
    findings.push_back(
        {"exposure-count", "one exposure message for each frame",
         textOf("%zu messages, %zu frames; %llu missing, %llu too many", log.exposuresUs().size(),
                log.frames().size(), count(counters.exposures_missing),
                count(counters.exposures_surplus)),
         "record the exposure topic from before the first frame; with constant "
         "exposure: exposure_source: parameter and exposure_time_us"});
  }
  const std::int64_t typical_us = survey.typicalExposureUs();
  if (typical_us > 0 && !survey.exposuresPlausible()) {
    findings.push_back({"exposure-implausible",
                        textOf("exposures of %lld us to the frame period, %.1f ms",
                               static_cast<long long>(RecordingSurvey::kLeastExposure_us),
                               static_cast<double>(log.periodNs()) / kMs),
                        textOf("%lld us (median)", static_cast<long long>(typical_us)),
                        "exposure_source: parameter and exposure_time_us as proposed below"});
  }
  return findings;
}

}  // namespace fast_edi
