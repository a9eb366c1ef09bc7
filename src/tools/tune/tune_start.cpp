#include "tools/tune/tune_start.hpp"

#include <algorithm>
#include <iostream>
#include <memory>
#include <stdexcept>

#include "command_line.hpp"
#include "fast_edi/bags/message_source.hpp"
#include "fast_edi/bags/open_messages.hpp"
#include "fast_edi/base/number_text.hpp"
#include "tuning/first_frame.hpp"
#include "tuning/shell_text.hpp"
#include "validation/proposed_parameters.hpp"
#include "validation_pass.hpp"

namespace fast_edi::tune {
namespace {

TopicNames topicsOf(const Arguments& arguments, const MessageSource& recording) {
  TopicNames wanted = arguments.topics;
  wanted.output = "/tune";  // writes none: topics of deblurred frames may be there already
  return tools::topicsIn(recording, wanted, nameOf(arguments.recordings));
}

}  // namespace

Start startOf(const Arguments& arguments) {
  const std::unique_ptr<MessageSource> recording = openMessages(arguments.recordings);
  Start start;
  start.topics = topicsOf(arguments, *recording);
  const tools::ValidationStart given =
      tools::validationStart(*recording, arguments.config, arguments.overrides);
  RecordingValidator validator(given.parameters, given.pipeline);
  const tools::ReadResult read =
      tools::readThrough(arguments.recordings, start.topics, "looking through", validator);
  if (arguments.as_given) {
    validator.endSurvey();
  } else {
    const ValidationReport report =
        tools::finishValidation(arguments.recordings, start.topics, validator);
    start.overrides = proposedOverrides(report.proposal, validator.survey());
    std::cout << "proposed by validate_bag: " << shellText(start.overrides) << "\n";
    if (!report.findings.empty()) {
      std::cout << "findings of validate_bag, which says more: " << report.findings.size() << "\n";
    }
    if (!given.parameters.thresholds_given && !report.proposal.thresholds) {
      std::cerr
          << "warning: contrast thresholds are not given, and validate_bag proposes none: starting "
             "from "
          << given.parameters.thresholds.on << "\n";
    }
  }
  if (!given.parameters.thresholds_given) {
    const std::string value = numberText(given.parameters.thresholds.on);
    start.overrides.insert(start.overrides.begin(),
                           {"contrast_threshold_on:=" + value, "contrast_threshold_off:=" + value});
  }
  start.overrides.insert(start.overrides.end(), arguments.overrides.begin(),
                         arguments.overrides.end());
  start.loaded = tools::loadParametersFor(*recording, arguments.config, start.overrides);
  tools::printDamage(nameOf(arguments.recordings), read.damage);
  tools::printMalformed(read.malformed);
  const DeblurParameters& deblur = start.loaded.deblur;
  for (const LoggedFrame& frame : validator.survey().frames().frames()) {
    start.exposures_us.push_back(
        static_cast<std::int32_t>(frame.length_ns / kNanosecondsPerMicrosecond));
    start.longest_exposure_ns = std::max(start.longest_exposure_ns, frame.length_ns);
  }
  const std::int64_t period_ns = validator.survey().frames().periodNs();
  start.ranges.exposures_known =
      start.longest_exposure_ns > 0 && deblur.exposure_source == ExposureSource::kTopic;
  // No exposure is longer than the time from frame to frame, but what is given counts.
  start.longest_exposure_ns =
      std::max({start.longest_exposure_ns, period_ns, deblur.exposure_time_ns});
  start.ranges.longest_exposure_us = start.longest_exposure_ns / kNanosecondsPerMicrosecond;
  start.ranges.time_offset_us =
      static_cast<double>(deblur.time_offset_ns) / static_cast<double>(kNanosecondsPerMicrosecond);
  start.busiest_frame = busiestFrame(validator.survey(), deblur.time_offset_ns);
  return start;
}

}  // namespace fast_edi::tune
