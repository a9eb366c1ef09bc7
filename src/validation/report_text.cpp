#include "validation/report_text.hpp"

#include <ostream>
#include <string>

namespace fast_edi {
namespace {

void printSummary(std::ostream& out, const RecordingSurvey& survey) {
  const FrameLog& frames = survey.frames();
  const EventEpoch* epoch = survey.timeline().longestEpoch();
  out << textOf("frames: %zu, every %.1f ms; exposure messages: %zu\n", frames.frames().size(),
                static_cast<double>(frames.periodNs()) * 1e-6, frames.exposuresUs().size());
  if (epoch == nullptr || survey.statistics() == nullptr) {
    out << "events: none\n";
    return;
  }
  const double seconds = static_cast<double>(epoch->last_ns - epoch->first_ns) * 1e-9;
  out << textOf("events: %.2f million, %.2f million/s, %.0f %% ON, sensor %dx%d\n",
                static_cast<double>(survey.timeline().events()) * 1e-6,
                seconds > 0.0 ? static_cast<double>(epoch->events) / seconds * 1e-6 : 0.0,
                100.0 * static_cast<double>(survey.statistics()->on()) /
                    static_cast<double>(survey.statistics()->on() + survey.statistics()->off()),
                survey.statistics()->size().width, survey.statistics()->size().height);
}

/// Nothing where events are as they should be, and were not given otherwise.
std::string mappingLines(const EventMapping& mapping, const EventMapping& given) {
  std::string lines;
  if (mapping.polarity == EventPolarity::kInverted) {
    lines += "event_polarity: inverted\n";
  } else if (given.polarity != mapping.polarity) {
    lines += "event_polarity: normal\n";
  }
  if (mapping.orientation != EventOrientation::kNormal ||
      given.orientation != mapping.orientation) {
    lines += std::string("event_orientation: ") + toString(mapping.orientation) + "\n";
  }
  return lines;
}

/// Nothing where the given ones are right.
std::string thresholdLines(const ParameterProposal& proposal) {
  return proposal.thresholds ? textOf("contrast_threshold_on: %.2f\ncontrast_threshold_off: %.2f\n",
                                      proposal.thresholds->on, proposal.thresholds->off)
                             : std::string();
}

}  // namespace

void printFinding(std::ostream& out, const Finding& finding) {
  out << "\n[" << finding.name << "]\n  expected: " << finding.expected
      << "\n  found:    " << finding.found << "\n  set:      " << finding.set << "\n";
}

void printReport(std::ostream& out, const RecordingSurvey& survey, const ValidationReport& report) {
  printSummary(out, survey);
  if (!report.outcomes.empty()) {
    out << "with these parameters: " << report.outcomes << "\n";
  }
  for (const std::string& note : report.notes) {
    out << "note: " << note << "\n";
  }
  for (const Finding& finding : report.findings) {
    printFinding(out, finding);
  }
  out << "\n"
      << (report.findings.empty() ? std::string("no findings")
                                  : textOf("%zu finding%s", report.findings.size(),
                                           report.findings.size() == 1 ? "" : "s"))
      << "; proposal:\n\n";
  const ParameterProposal& proposal = report.proposal;
  const bool by_topic = proposal.exposure_time_us == 0 && !survey.frames().exposuresUs().empty();
  out << "stamp_reference: " << instantName(proposal.stamp_reference) << "\n"
      << "time_offset_us: " << proposal.time_offset_us
      << (proposal.offset_remark.empty() ? "" : "  # " + proposal.offset_remark) << "\n"
      << mappingLines(proposal.event_mapping, proposal.given_mapping) << thresholdLines(proposal)
      << "exposure_time_us: " << proposal.exposure_time_us
      << (proposal.exposure_time_us > 0 ? ""
          : by_topic                    ? "  # the exposure topic has it"
                     : "  # not known: cannot be told, see the camera's settings")
      << "\n";
}

}  // namespace fast_edi
