#include "validation/stream_checks.hpp"
#include "fast_edi/base/sensor_size.hpp"
#include "validation/advice.hpp"

#include <cstdlib>
#include <map>
#include <string>
#include <utility>

namespace fast_edi {
namespace {

/// Unordered events below this part come from the merging of packets and are few.
constexpr double kLeastUnorderedPart = 1e-5;

void checkSizes(const RecordingSurvey& survey, std::vector<Finding>& findings) {
  std::map<std::pair<int, int>, std::uint64_t> frame_sizes;
  for (const LoggedFrame& frame : survey.frames().frames()) {
    ++frame_sizes[{frame.size.width, frame.size.height}];
  }
  const auto listed = [](const std::map<std::pair<int, int>, std::uint64_t>& sizes) {
    std::string text;
    for (const auto& entry : sizes) {
      text += textOf("%s%dx%d in %llu", text.empty() ? "" : ", ", entry.first.first,
                     entry.first.second, count(entry.second));
    }
    return text;
  };
  if (frame_sizes.size() > 1) {
    findings.push_back({"frame-size-changes", "one size of all frames",
                        listed(frame_sizes) + " frames",
                        adviceFor(Remedy::kFixedFrameRegion, survey.parameters().origin) +
                            "; frames of another size than the event sensor are passed through"});
  }
  if (survey.eventSizes().size() > 1) {
    findings.push_back({"event-size-changes", "one size in all event arrays",
                        listed(survey.eventSizes()) + " arrays",
                        "record again: the size of the event sensor changes"});
  }
  if (frame_sizes.size() == 1 && survey.eventSizes().size() == 1 &&
      frame_sizes.begin()->first != survey.eventSizes().begin()->first) {
    const auto& frame = frame_sizes.begin()->first;
    const auto& events = survey.eventSizes().begin()->first;
    findings.push_back({"sizes-differ", "event arrays and frames of the same size",
                        "frames " + sizeText(frame.first, frame.second) + ", event arrays " +
                            sizeText(events.first, events.second),
                        adviceFor(Remedy::kWholeSensor, survey.parameters().origin) +
                            "; such frames are passed through"});
  }
  for (const auto& fault : survey.frames().faults()) {
    findings.push_back({"encoding",
                        "mono8, 8UC1, mono16, or rgb, bgr, rgba, bgra, bayer of 8 or 16 bits",
                        textOf("%llu frames with %s", count(fault.second), fault.first.c_str()),
                        adviceFor(Remedy::kFrameEncoding, survey.parameters().origin) +
                            "; such frames are passed through"});
  }
  const EventStatistics* statistics = survey.statistics();
  if (statistics != nullptr && statistics->outside() > 0) {
    findings.push_back(
        {"events-outside", "all events on the sensor",
         textOf("%llu events outside %s", count(statistics->outside()),
                sizeText(statistics->size().width, statistics->size().height).c_str()),
         "record again with the right sensor size; these events are dropped"});
  }
}

void checkLosses(const RecordingSurvey& survey, std::vector<Finding>& findings) {
  if (survey.arrayGaps() > 0) {
    findings.push_back({"arrays-dropped", "header.seq of event arrays without gaps",
                        textOf("%llu gaps", count(survey.arrayGaps())),
                        adviceFor(Remedy::kFewerLosses, survey.parameters().origin) +
                            "; frames of these times are passed through"});
  }
  if (survey.frames().gaps() > 0) {
    findings.push_back({"frames-dropped", "header.seq of frames without gaps",
                        textOf("%llu gaps", count(survey.frames().gaps())),
                        adviceFor(Remedy::kFewerLosses, survey.parameters().origin)});
  }
}

void checkClocks(const RecordingSurvey& survey, std::vector<Finding>& findings) {
  const EventTimeline& timeline = survey.timeline();
  const FrameLog& frames = survey.frames();
  const EventEpoch* longest = timeline.longestEpoch();
  bool early = false;
  for (const EventEpoch& epoch : timeline.epochs()) {
    if (epoch.first_ns < EventTimeline::kEarliest_ns &&
        longest->first_ns >= EventTimeline::kEarliest_ns) {
      early = true;
      findings.push_back({"stamps-near-1970", "stamps of today from the first event on",
                          textOf("%.0f ms of events stamped %.3f s after 1970",
                                 static_cast<double>(epoch.last_ns - epoch.first_ns) / kMs,
                                 static_cast<double>(epoch.first_ns) * 1e-9),
                          adviceFor(Remedy::kLaterStart, survey.parameters().origin)});
      break;
    }
  }
  const std::uint64_t jumps = timeline.backwardJumps() + timeline.forwardJumps();
  if (jumps > (early ? 1U : 0U)) {
    findings.push_back(
        {"time-jumps",
         textOf("event times that go on (back by at most %.0f ms, ahead by at most %.0f ms)",
                static_cast<double>(EventTimeline::kMaxBackwardJump_ns) / kMs,
                static_cast<double>(EventTimeline::kMaxForwardJump_ns) / kMs),
         textOf("%llu jumps back, %llu ahead; the largest by %.3f s",
                count(timeline.backwardJumps()), count(timeline.forwardJumps()),
                static_cast<double>(timeline.largestJump()) * 1e-9),
         "do not reset the camera's clock while recording; frames at the jump are passed through"});
  }
  if (static_cast<double>(timeline.unordered()) >
      kLeastUnorderedPart * static_cast<double>(timeline.events())) {
    findings.push_back({"events-unordered", "event times that never decrease",
                        textOf("%llu events (%.2f %%) earlier than one before, by up to %.3f ms",
                               count(timeline.unordered()),
                               100.0 * static_cast<double>(timeline.unordered()) /
                                   static_cast<double>(timeline.events()),
                               static_cast<double>(timeline.largestStepBack()) / kMs),
                        "sort the events when the recording is made; late ones are dropped"});
  }
  if (frames.repeatedStamps() > 0) {
    findings.push_back(
        {"stamps-repeated", "a stamp of its own for each frame",
         textOf("%llu frames stamped as the one before", count(frames.repeatedStamps())),
         "record again; such frames give no output"});
  }
  if (frames.earlierStamps() > timeline.backwardJumps()) {
    findings.push_back(
        {"stamps-backwards", "frame stamps that increase",
         textOf("%llu frames stamped before the one before", count(frames.earlierStamps())),
         "record again; such frames give no output unless the events jump, too"});
  }
}

/// Stamps that go on at another rate: no offset makes up for them.
void checkRates(const ClockRelation& clocks, std::vector<Finding>& findings) {
  const std::string expected = "events and frames stamped by the same clock";
  if (clocks.factor == 1) {
    findings.push_back(
        {"clocks-differ", expected,
         textOf("frame stamps go on %.2f times as fast as those of the events", clocks.rate),
         "convert the recording with frame stamps of the events' clock"});
    return;
  }
  const std::string what = clocks.divided       ? textOf("divided by %d", clocks.factor)
                           : clocks.factor == 2 ? std::string("doubled")
                                                : textOf("multiplied by %d", clocks.factor);
  const char* undo = clocks.divided ? "multiplied" : "divided";
  findings.push_back(
      {"clocks-differ", expected,
       clocks.exact
           ? textOf("frame stamps are exactly %s: %s by %d they agree with the events",
                    what.c_str(), undo, clocks.factor)
           : textOf("frame stamps go on %.2f times as fast as those of the events: the time "
                    "since some instant was %s",
                    clocks.rate, what.c_str()),
       textOf("convert the recording with frame stamps %s by %d: no time_offset_us makes up for "
              "them; what is proposed below is for stamps so corrected",
              undo, clocks.factor)});
}

void checkOffset(const RecordingSurvey& survey, std::vector<Finding>& findings) {
  // A clock that was set back has no one offset; that it was is a finding of its own.
  if (!survey.clocks() || survey.timeline().backwardJumps() > 0) {
    return;
  }
  if (survey.clocks()->ratesDiffer()) {
    checkRates(*survey.clocks(), findings);
    return;
  }
  const std::int64_t offset_ns = survey.roughClockOffsetNs() - survey.parameters().time_offset_ns;
  if (std::abs(offset_ns) > RecordingSurvey::kLargestDelay_ns) {
    findings.push_back({"clocks-differ", "events and frames stamped by the same clock",
                        textOf("the events' clock is about %.2f s %s the frames', by the times of "
                               "recording",
                               static_cast<double>(std::abs(offset_ns)) * 1e-9,
                               offset_ns > 0 ? "ahead of" : "behind"),
                        "time_offset_us as proposed below"});
  }
}

}  // namespace

std::vector<Finding> checkStreams(const RecordingSurvey& survey) {
  std::vector<Finding> findings;
  checkSizes(survey, findings);
  checkLosses(survey, findings);
  checkClocks(survey, findings);
  checkOffset(survey, findings);
  return findings;
}

}  // namespace fast_edi
