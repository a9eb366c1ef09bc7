#include "simulation/recording_faults.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>

namespace fast_edi {
namespace {

/// Far enough back that no interval to it overflows.
constexpr std::int64_t kLongAgo_ns = std::numeric_limits<std::int64_t>::min() / 2;
/// How much too early an unordered event is stamped.
constexpr std::int64_t kUnordered_ns = 200 * kNanosecondsPerMicrosecond;

std::int64_t numberOf(const std::string& fault, const std::string& text) {
  try {
    std::size_t used = 0;
    const long long value = std::stoll(text, &used);
    if (used == text.size()) {
      return value;
    }
  } catch (const std::logic_error&) {  // neither a number nor within range: reported below
  }
  throw std::invalid_argument("--fault " + fault + ": expected a whole number behind =, got \"" +
                              text + "\"");
}

}  // namespace

const std::vector<FaultDescription>& faultDescriptions() {
  static const std::vector<FaultDescription> descriptions = {
      {"background-activity-filter", &RecordingFaults::background_activity_filter_us, 20'000,
       "events without a neighbour's within so many us are missing"},
      {"refractory-filter", &RecordingFaults::refractory_filter_us, 1'000,
       "events of a pixel within so many us of its last are missing"},
      {"skip-filter", &RecordingFaults::skip_filter, 1, "one event is missing after each so many"},
      {"suppress-on", &RecordingFaults::suppress_on, 1, "ON events are missing"},
      {"suppress-off", &RecordingFaults::suppress_off, 1, "OFF events are missing"},
      {"flatten-polarity", &RecordingFaults::flatten_polarity, 1, "all events are OFF"},
      {"invert-polarity", &RecordingFaults::invert_polarity, 1, "ON and OFF are exchanged"},
      {"event-orientation", &RecordingFaults::event_orientation, 2,
       "events are turned: 1 flip_x, 2 flip_y, 3 rotate_180, 4 transpose, 5 rotate_90, 6 "
       "rotate_270, 7 transverse undo it"},
      {"coordinates-from", &RecordingFaults::coordinates_from, 1,
       "columns and rows of events count from so much"},
      {"event-hole", &RecordingFaults::event_hole_ms, 30,
       "no events for so many ms from the middle on"},
      {"no-events-between", &RecordingFaults::no_events_between, 1,
       "no events outside the exposures"},
      {"unordered-events", &RecordingFaults::unordered_events, 1'000,
       "one event in so many is stamped 200 us too early"},
      {"clock-offset", &RecordingFaults::clock_offset_us, 10'000,
       "the events' clock is so many us ahead of the frames'"},
      {"frame-stamps-times", &RecordingFaults::frame_stamps_times, 2,
       "frame stamps are so many times what they should be"},
      {"time-jump-back", &RecordingFaults::time_jump_back_ms, 2'000,
       "all stamps jump back by so many ms in the middle"},
      {"start-near-1970", &RecordingFaults::start_near_1970_ms, 100,
       "stamps count from 1970 for the first so many ms"},
      {"repeated-stamp", &RecordingFaults::repeated_stamp, 1,
       "the frame in the middle has the stamp of the one before"},
      {"dropped-arrays", &RecordingFaults::dropped_arrays, 1,
       "so many event arrays are missing from the middle on"},
      {"dropped-images", &RecordingFaults::dropped_images, 1,
       "so many frames are missing from the middle on"},
      {"exposure-of-next", &RecordingFaults::exposure_of_next, 1,
       "exposure messages tell that of the next frame; see --exposure-swing"},
      {"dropped-exposures", &RecordingFaults::dropped_exposures, 3,
       "one exposure message in so many is missing"},
      {"exposure-percent", &RecordingFaults::exposure_percent, 50,
       "exposure messages tell so many percent of the truth"},
      {"more-rows", &RecordingFaults::more_rows, 8,
       "frames of the second half have so many rows more"},
      {"event-size", &RecordingFaults::event_size, 2,
       "event arrays state a width and height so many pixels too large"},
      {"unknown-encoding", &RecordingFaults::unknown_encoding, 1,
       "frames state an encoding that is not supported"},
  };
  return descriptions;
}

void plantFault(const std::string& fault, RecordingFaults& faults) {
  const std::size_t equals = fault.find('=');
  const std::string name = fault.substr(0, equals);
  std::string known;
  for (const FaultDescription& description : faultDescriptions()) {
    if (name == description.name) {
      faults.*description.value = equals == std::string::npos
                                      ? description.usual
                                      : numberOf(fault, fault.substr(equals + 1));
      return;
    }
    known += (known.empty() ? "" : ", ") + std::string(description.name);
  }
  throw std::invalid_argument("--fault: expected one of " + known + ", got \"" + name + "\"");
}

FaultyStream::FaultyStream(const RecordingFaults& faults, SensorSize size,
                           const TimingSettings& timing)
    : faults_(faults),
      size_(size),
      start_ns_(timing.start_ns),
      middle_ns_(timing.start_ns + kNanosecondsPerMicrosecond *
                                       (timing.lead_us + timing.period_us * (timing.frames / 2))),
      until_skip_(faults.skip_filter),
      last_raw_ns_(size.pixelCount(), kLongAgo_ns),
      last_passed_ns_(size.pixelCount(), kLongAgo_ns) {}

/// As the hardware does it: a pixel's eight neighbours count, removed events among them, the pixel
/// itself does not.
bool FaultyStream::isSupported(const Event& event) {
  const std::int64_t since_ns =
      event.t_ns - faults_.background_activity_filter_us * kNanosecondsPerMicrosecond;
  const int last_x = std::min(size_.width - 1, event.x + 1);
  const int last_y = std::min(size_.height - 1, event.y + 1);
  bool supported = false;
  for (int y = std::max(0, event.y - 1); y <= last_y; ++y) {
    for (int x = std::max(0, event.x - 1); x <= last_x; ++x) {
      const std::size_t pixel = pixelIndex(x, y);
      supported = supported || ((x != event.x || y != event.y) && last_raw_ns_[pixel] >= since_ns);
    }
  }
  last_raw_ns_[pixelIndex(event.x, event.y)] = event.t_ns;
  return supported;
}

bool FaultyStream::passes(const Event& event) {
  const std::int64_t hole_ns = faults_.event_hole_ms * kNanosecondsPerMillisecond;
  if (event.t_ns >= middle_ns_ && event.t_ns < middle_ns_ + hole_ns) {
    return false;
  }
  if (faults_.background_activity_filter_us > 0 && !isSupported(event)) {
    return false;
  }
  if (faults_.refractory_filter_us > 0) {
    std::int64_t& last_ns = last_passed_ns_[pixelIndex(event.x, event.y)];
    if (event.t_ns - last_ns < faults_.refractory_filter_us * kNanosecondsPerMicrosecond) {
      return false;
    }
    last_ns = event.t_ns;
  }
  if ((faults_.suppress_on != 0 && event.on) || (faults_.suppress_off != 0 && !event.on)) {
    return false;
  }
  if (faults_.skip_filter > 0 && until_skip_-- == 0) {
    until_skip_ = faults_.skip_filter;
    return false;
  }
  return true;
}

void FaultyStream::apply(const ExposureInterval& exposure, std::vector<Event>& events) {
  const auto removed = std::remove_if(events.begin(), events.end(), [&](const Event& event) {
    const bool inside = event.t_ns >= exposure.start_ns && event.t_ns < exposure.end_ns;
    return (faults_.no_events_between != 0 && !inside) || !passes(event);
  });
  events.erase(removed, events.end());
  const EventMapping mapping = turned();
  for (Event& event : events) {
    event = mapping.apply(event, size_);
    event.x = static_cast<std::uint16_t>(event.x + faults_.coordinates_from);
    event.y = static_cast<std::uint16_t>(event.y + faults_.coordinates_from);
    event.on = faults_.flatten_polarity == 0 && (event.on != (faults_.invert_polarity != 0));
    ++events_;
    if (faults_.unordered_events > 0 && events_ % faults_.unordered_events == 0) {
      event.t_ns = std::max(start_ns_, event.t_ns - kUnordered_ns);
    }
  }
}

/// What is undone by the orientation named.
EventMapping FaultyStream::turned() const {
  const auto place = static_cast<std::size_t>(faults_.event_orientation);
  EventMapping mapping;
  mapping.orientation = kEventOrientations[place % kEventOrientations.size()].second;
  if (mapping.orientation == EventOrientation::kRotate90) {
    mapping.orientation = EventOrientation::kRotate270;
  } else if (mapping.orientation == EventOrientation::kRotate270) {
    mapping.orientation = EventOrientation::kRotate90;
  }
  return mapping;
}

SensorSize FaultyStream::eventSize(SensorSize size) const {
  const SensorSize stated = turned().apply(size);
  const auto wrong_px = static_cast<int>(faults_.event_size);
  return {stated.width + wrong_px, stated.height + wrong_px};
}

std::int64_t FaultyStream::faultyClock(std::int64_t t_ns) const {
  if (t_ns < start_ns_ + faults_.start_near_1970_ms * kNanosecondsPerMillisecond) {
    return t_ns - start_ns_;
  }
  return t_ns < middle_ns_ ? t_ns : t_ns - faults_.time_jump_back_ms * kNanosecondsPerMillisecond;
}

std::int64_t FaultyStream::eventStamp(std::int64_t t_ns) const {
  return std::max<std::int64_t>(
      0, faultyClock(t_ns) + faults_.clock_offset_us * kNanosecondsPerMicrosecond);
}

std::int64_t FaultyStream::frameStamp(std::int64_t t_ns) const {
  return faultyClock(t_ns) * std::max<std::int64_t>(1, faults_.frame_stamps_times);
}

}  // namespace fast_edi
