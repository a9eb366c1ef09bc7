#include "validation/timing_checks.hpp"

#include <algorithm>
#include <cmath>

#include "fast_edi/calibration/contrast_from_bias.hpp"
#include "validation/advice.hpp"

namespace fast_edi {
namespace {

constexpr double kUs = static_cast<double>(kNanosecondsPerMicrosecond);
/// Shifts this near to start, mid or end, as part of the exposure, are taken as that.
constexpr double kNear = 0.10;
/// Estimates are believed to differ when they do by so many standard deviations.
constexpr double kSigmas = 3.0;
constexpr double kLargestSigma_ns = 3.0 * kMs;
constexpr double kWrongLength = 0.25;
constexpr double kWrongThreshold = 1.3;  // as far as refine_contrast learns
constexpr double kThresholdSigmas = 2.0;
constexpr double kProposalStep_us = 100.0;
/// Of an offset by the times of recording.
constexpr std::int64_t kRoughStep_ns = kNanosecondsPerMillisecond;

/// Where the exposure's middle lies behind an instant, as part of its length.
double partOf(ExposureInstant instant) {
  switch (instant) {
    case ExposureInstant::kStart:
      return 0.5;
    case ExposureInstant::kEnd:
      return -0.5;
    case ExposureInstant::kMid:
      break;
  }
  return 0.0;
}

std::int64_t rounded(double us) {
  return static_cast<std::int64_t>(kProposalStep_us) * std::llround(us / kProposalStep_us);
}

/// The shift of the exposures' middles, however it was found.
struct Shift {
  double ns = 0.0;
  double sigma_ns = 0.0;
  double length_ns = 0.0;
};

void proposeStamps(const RecordingSurvey& survey, const Shift& shift,
                   std::optional<ExposureInstant> separated, double offset_ns,
                   TimingVerdict& verdict) {
  const AssumedParameters& assumed = survey.parameters();
  const double near_ns = kNear * shift.length_ns;
  ParameterProposal& proposal = verdict.proposal;
  if (separated) {
    proposal.stamp_reference = *separated;
    proposal.time_offset_us = std::abs(offset_ns) <= near_ns ? 0 : rounded(offset_ns / kUs);
  } else {
    proposal.stamp_reference = assumed.stamp_reference;
    proposal.time_offset_us =
        rounded((shift.ns - partOf(assumed.stamp_reference) * shift.length_ns) / kUs);
    for (const ExposureInstant instant : {assumed.stamp_reference, ExposureInstant::kMid,
                                          ExposureInstant::kStart, ExposureInstant::kEnd}) {
      if (std::abs(shift.ns - partOf(instant) * shift.length_ns) <= near_ns) {
        proposal.stamp_reference = instant;
        proposal.time_offset_us = 0;
        break;
      }
    }
  }
  const double assumed_ns = partOf(assumed.stamp_reference) * shift.length_ns +
                            static_cast<double>(assumed.time_offset_ns);
  const double tolerance_ns = std::max(near_ns, kSigmas * shift.sigma_ns);
  const bool same = separated.value_or(assumed.stamp_reference) == assumed.stamp_reference;
  if (std::abs(shift.ns - assumed_ns) <= tolerance_ns && same) {
    proposal.stamp_reference = assumed.stamp_reference;
    proposal.time_offset_us = assumed.time_offset_ns / kNanosecondsPerMicrosecond;
    return;
  }
  verdict.findings.push_back(
      {"timing",
       textOf("exposures with their middle %.2f ms behind the stamps (stamp_reference: %s, "
              "time_offset_us: %lld)",
              assumed_ns / kMs, instantName(assumed.stamp_reference).c_str(),
              static_cast<long long>(assumed.time_offset_ns / kNanosecondsPerMicrosecond)),
       textOf("%.2f +- %.2f ms", shift.ns / kMs, shift.sigma_ns / kMs),
       textOf("stamp_reference: %s, time_offset_us: %lld",
              instantName(proposal.stamp_reference).c_str(),
              static_cast<long long>(proposal.time_offset_us))});
}

std::string joined(const std::vector<std::string>& texts) {
  std::string all;
  for (const std::string& text : texts) {
    all += (all.empty() ? "" : ", and ") + text;
  }
  return all;
}

void judgeThresholds(const RecordingSurvey& survey, const TimingEstimate& estimate,
                     TimingVerdict& verdict) {
  const bool are_given = survey.parameters().thresholds_given;
  const ContrastThresholds& given = survey.parameters().thresholds;
  const ContrastThresholds& found = estimate.thresholds;
  const ContrastThresholds& sigmas = estimate.threshold_sigmas;
  std::string note = textOf("contrast thresholds that fit best: ON %.2f +- %.2f, OFF %.2f +- %.2f",
                            found.on, found.on * sigmas.on, found.off, found.off * sigmas.off);
  if (are_given) {
    note += textOf(" (given: %.2f, %.2f)", given.on, given.off);
  }
  // What the other tools would warn of is no proposal.
  const std::vector<std::string> warnings = contrastWarnings(found);
  if (!warnings.empty()) {
    note += "; not proposed, because " + joined(warnings) +
            (estimate.frames_stretched
                 ? "; these frames were stretched (see below)"
                 : "; frames whose contrast was stretched, or whose DN are not linear in light "
                   "(response_file, response_offset_dn), look like that");
  }
  verdict.notes.push_back(note);
  if (!are_given && warnings.empty()) {
    verdict.proposal.thresholds = found;
  }
  const double ratio = std::sqrt(found.on * found.off / (given.on * given.off));
  const double sigma = 0.5 * std::hypot(sigmas.on, sigmas.off);
  if (!are_given || std::abs(std::log(ratio)) < std::log(kWrongThreshold) ||
      std::abs(std::log(ratio)) < kThresholdSigmas * sigma) {
    return;
  }
  const char* cause = ratio > 1.0 ? ", or events are missing (skip filter)" : "";
  Finding finding{
      "contrast", textOf("events that stand for %.2f (ON) and %.2f (OFF)", given.on, given.off),
      textOf("%.2f and %.2f fit best: the biases are others%s", found.on, found.off, cause), ""};
  if (warnings.empty()) {
    verdict.proposal.thresholds = found;
    finding.set =
        (ratio > 1.0
             ? adviceFor(Remedy::kSkipFilterOff, survey.parameters().origin) + "; if it was: "
             : "") +
        textOf("contrast_threshold_on: %.2f, contrast_threshold_off: %.2f", found.on, found.off);
  } else {
    finding.found += ", or the frames are not linear in light";
    finding.set =
        "the biases of the recording; what fits best is not usual (see the note) and not proposed";
  }
  verdict.findings.push_back(finding);
}

void judgeLength(const RecordingSurvey& survey, const TimingEstimate& estimate,
                 TimingVerdict& verdict, bool lengths_known) {
  const double length_us = estimate.length_ns * estimate.length_factor / kUs;
  if (!estimate.length_told) {
    verdict.notes.push_back("the length of the exposure cannot be told from frames and events");
    return;
  }
  verdict.notes.push_back(textOf("exposure that fits best: %.1f ms +- %.0f %%", length_us * 1e-3,
                                 100.0 * estimate.length_sigma));
  if (!lengths_known) {
    verdict.proposal.exposure_time_us = rounded(length_us);
    return;
  }
  const double deviation = std::abs(std::log(estimate.length_factor));
  if (deviation > kWrongLength && deviation > kSigmas * estimate.length_sigma) {
    verdict.proposal.exposure_time_us = rounded(length_us);
    verdict.findings.push_back(
        {"exposure-wrong",
         textOf("exposures of %.2f ms, as %s", estimate.length_ns / kMs,
                survey.frames().exposuresUs().empty() ? "given" : "the exposure topic says"),
         textOf("%.2f ms +- %.0f %% fits frames and events best", length_us * 1e-3,
                100.0 * estimate.length_sigma),
         textOf("exposure_source: parameter, exposure_time_us: %lld",
                static_cast<long long>(verdict.proposal.exposure_time_us))});
  }
}

}  // namespace

TimingVerdict judgeTiming(const RecordingSurvey& survey, const TimingEstimate& estimate,
                          const std::optional<ExposuresByEvents>& by_events) {
  TimingVerdict verdict;
  const AssumedParameters& assumed = survey.parameters();
  verdict.proposal.stamp_reference = assumed.stamp_reference;
  verdict.proposal.time_offset_us = assumed.time_offset_ns / kNanosecondsPerMicrosecond;
  verdict.proposal.exposure_time_us = assumed.exposure_time_ns / kNanosecondsPerMicrosecond;
  const bool corrected = survey.clocks() && survey.clocks()->factor != 1;
  if (corrected) {
    verdict.proposal.offset_remark =
        textOf("for frame stamps %s by %d", survey.clocks()->divided ? "multiplied" : "divided",
               survey.clocks()->factor);
  }
  const std::int64_t rough_ns = survey.roughClockOffsetNs();
  const bool roughly =
      std::abs(rough_ns - assumed.time_offset_ns) > RecordingSurvey::kLargestDelay_ns;
  if (roughly) {  // until the estimate says it better
    verdict.proposal.time_offset_us =
        rough_ns / kRoughStep_ns * kRoughStep_ns / kNanosecondsPerMicrosecond;
  }
  const auto& frames = survey.frames().frames();
  const bool lengths_known = std::any_of(frames.begin(), frames.end(), [&](const LoggedFrame& f) {
    return survey.assumedLengthNs(f) > 0;
  });
  if (by_events) {
    verdict.notes.push_back(
        textOf("exposures as the events show them: %.2f ms long, their middle %.2f +- %.2f ms "
               "behind the stamps",
               by_events->length_ns / kMs, by_events->shift_ns / kMs, by_events->sigma_ns / kMs));
    if (!lengths_known) {
      verdict.proposal.exposure_time_us = rounded(by_events->length_ns / kUs);
    }
    proposeStamps(survey, {by_events->shift_ns, by_events->sigma_ns, by_events->length_ns},
                  std::nullopt, 0.0, verdict);
    return verdict;
  }
  if (!estimate.told || estimate.shift_sigma_ns > kLargestSigma_ns) {
    verdict.notes.push_back(
        "stamps, offset and exposure cannot be told: " +
        (estimate.told ? textOf("the shift is uncertain by %.1f ms", estimate.shift_sigma_ns / kMs)
                       : estimate.reason));
    if (roughly) {
      verdict.notes.push_back(
          "time_offset_us is by the times of recording, good to some ten milliseconds");
    }
    return verdict;
  }
  verdict.notes.push_back(textOf(
      "middle of the exposures %.2f +- %.2f ms behind the stamps, from %zu pairs of frames "
      "(correlation %.2f); this contains the pixels' own delay, 0.5 ms in bright to 5 ms in dim "
      "light, which fast_edi learns by itself (refine_delay)",
      estimate.shift_ns / kMs, estimate.shift_sigma_ns / kMs, estimate.samples,
      estimate.correlation));
  if (!estimate.reference && lengths_known) {
    verdict.notes.push_back(
        "with equal exposure times, what stamps mean and the offset of the clocks show as one sum");
  } else if (estimate.reference) {
    verdict.notes.push_back(textOf(
        "exposure times vary: stamps mean the %s of the exposure, and events come %.2f ms later",
        instantName(*estimate.reference).c_str(), estimate.offset_ns / kMs));
  }
  const double length_ns = estimate.length_ns * (lengths_known ? 1.0 : estimate.length_factor);
  if (lengths_known || estimate.length_told) {
    proposeStamps(survey, {estimate.shift_ns, estimate.shift_sigma_ns, length_ns},
                  estimate.reference, estimate.offset_ns, verdict);
  }
  judgeLength(survey, estimate, verdict, lengths_known);
  judgeThresholds(survey, estimate, verdict);
  if (estimate.frames_stretched) {
    verdict.findings.push_back(
        {"frames-stretched", "frames as the sensor gives them",
         "every frame spans 0 to 255 exactly, as if each had been stretched to that",
         "record without normalisation or automatic contrast: thresholds that fit such frames are "
         "not those of the sensor, and brightness varies from frame to frame"});
  }
  if (estimate.lengths_one_late) {
    verdict.findings.push_back(
        {"exposure-of-next-frame", "exposure messages that belong to the frame before them",
         "lengths fit when each is taken for the next frame (drivers before 2017 sent the "
         "requested next value)",
         adviceFor(Remedy::kHeldExposure, survey.parameters().origin)});
  }
  return verdict;
}

}  // namespace fast_edi
