#include "support/random_schedule.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

#include "support/event_generators.hpp"

namespace fast_edi::testing {
namespace {

constexpr std::int64_t kUs = kNanosecondsPerMicrosecond;
constexpr std::int64_t kMs = kNanosecondsPerMillisecond;
constexpr std::int64_t kPeriod_ns = 40 * kMs;
constexpr std::int64_t kReadout_ns = 5 * kMs;
/// Mean time between two events.
constexpr std::int64_t kEventInterval_ns = 20 * kUs;
/// Stamps on the wire are 32-bit seconds.
constexpr std::int64_t kLastSecond = UINT32_MAX;

/// Messages of one topic, in order.
struct Topics {
  Schedule events;
  Schedule frames;
  Schedule exposures;
};

std::shared_ptr<const std::vector<std::uint8_t>> makePixels(Random& random, SensorSize size,
                                                            PixelFormat format) {
  const SensorSize samples{size.width * bytesPerPixel(format), size.height};
  return std::make_shared<const std::vector<std::uint8_t>>(makeGreyImage(samples, random()));
}

/// Whether a pixel grows brighter all the time, where each grows steadily brighter or darker.
bool growsBrighter(int x, int y) {
  return (x + y) % 2 == 0;
}

/// Of pixels that grow steadily brighter or darker from each even frame to the next: thresholds can
/// be learned from such a pair.
std::shared_ptr<const std::vector<std::uint8_t>> makeSteadyPixels(Random& random, SensorSize size,
                                                                  PixelFormat format, int frame) {
  constexpr int kDark_dn = 30;
  constexpr int kBright_dn = 210;
  constexpr int kNoise_dn = 5;
  auto pixels = std::make_shared<std::vector<std::uint8_t>>();
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const bool is_bright = growsBrighter(x, y) == (frame % 2 == 1);
      const std::int64_t level =
          (is_bright ? kBright_dn : kDark_dn) + uniform(random, -kNoise_dn, kNoise_dn);
      pixels->insert(pixels->end(), static_cast<std::size_t>(bytesPerPixel(format)),
                     static_cast<std::uint8_t>(level));
    }
  }
  return pixels;
}

Schedule eventArrays(Random& random, const CameraRun& run, bool is_steady) {
  const std::int64_t duration_ns = (run.frames + 1) * kPeriod_ns;
  std::vector<Event> events = makeEvents(
      EventScene::kUniform, {run.size, static_cast<std::size_t>(duration_ns / kEventInterval_ns),
                             run.start_ns, duration_ns, random()});
  if (is_steady) {
    for (Event& event : events) {
      event.on = growsBrighter(event.x, event.y);
    }
  }
  events.front().t_ns = run.start_ns;
  const std::int64_t longest_ns = uniform(random, 1, 40) * kMs;
  Schedule arrays;
  std::uint32_t sequence = run.first_sequence;
  for (std::size_t begin = 0; begin < events.size();) {
    const std::int64_t until_ns = events[begin].t_ns + uniform(random, 1, longest_ns);
    std::size_t end = begin + 1;
    while (end < events.size() && events[end].t_ns < until_ns) {
      ++end;
    }
    ScheduledMessage message;
    message.now_ns = run.first_arrival_ns + events[end - 1].t_ns - run.start_ns;
    message.size = run.size;
    message.records = toWire({events.begin() + static_cast<std::ptrdiff_t>(begin),
                              events.begin() + static_cast<std::ptrdiff_t>(end)});
    message.sequence = sequence++;
    arrays.push_back(std::move(message));
    begin = end;
  }
  return arrays;
}

Topics cameraTopics(Random& random, const CameraRun& run) {
  Topics topics;
  const bool is_steady = chance(random, 50);
  for (int i = 0; i < run.frames; ++i) {
    const auto length_us = static_cast<std::int32_t>(uniform(random, 1'000, 30'000));
    const std::int64_t end_ns = (i + 1) * kPeriod_ns - uniform(random, 0, 50) * kUs;
    ScheduledMessage frame;
    frame.kind = MessageKind::kFrame;
    frame.now_ns = run.first_arrival_ns + end_ns + kReadout_ns;
    frame.size = run.size;
    // The middle of the exposure, rounded as the driver does it.
    frame.stamp_ns = run.start_ns + end_ns - length_us * kUs + length_us / 2 * kUs;
    frame.format = run.format;
    frame.pixels = is_steady ? makeSteadyPixels(random, run.size, run.format, i)
                             : makePixels(random, run.size, run.format);
    ScheduledMessage exposure;
    exposure.kind = MessageKind::kExposure;
    exposure.now_ns = frame.now_ns + 10 * kUs;
    exposure.exposure_us = length_us;
    topics.frames.push_back(std::move(frame));
    topics.exposures.push_back(std::move(exposure));
  }
  topics.events = eventArrays(random, run, is_steady);
  return topics;
}

/// Merges topics by arrival; of equal times in random order of the topics.
Schedule merge(Random& random, const Topics& topics) {
  std::array<const Schedule*, 3> order{&topics.events, &topics.frames, &topics.exposures};
  std::shuffle(order.begin(), order.end(), random);
  Schedule all;
  for (const Schedule* topic : order) {
    all.insert(all.end(), topic->begin(), topic->end());
  }
  std::stable_sort(
      all.begin(), all.end(),
      [](const ScheduledMessage& a, const ScheduledMessage& b) { return a.now_ns < b.now_ns; });
  return all;
}

/// Any stamp, often one of the odd ones near the ends of what 32-bit seconds hold.
std::int64_t anyStamp(Random& random) {
  if (chance(random, 30)) {
    return uniform(random, 0, 1000) * kMs;
  }
  if (chance(random, 10)) {
    return kLastSecond * kNanosecondsPerSecond - uniform(random, 0, 1000) * kMs;
  }
  return uniform(random, 0, 4'000'000) * kMs;
}

void makeOdd(Random& random, Topics& topics) {
  for (ScheduledMessage& frame : topics.frames) {
    if (chance(random, 5)) {
      frame.stamp_ns = anyStamp(random);
    }
    if (chance(random, 3)) {
      frame.size = {frame.size.width, frame.size.height + 1};
      frame.pixels = makePixels(random, frame.size, frame.format);
    }
    frame.supported = !chance(random, 3);
  }
  for (ScheduledMessage& exposure : topics.exposures) {
    if (chance(random, 5)) {
      exposure.exposure_us = static_cast<std::int32_t>(uniform(random, -10, 2'000'000));
    }
    if (chance(random, 2)) {
      exposure.exposure_us = static_cast<std::int32_t>(random());
    }
  }
  // Stray events of any time and place, alone in their arrays; now and then another sensor size.
  for (int i = 0; i < 3; ++i) {
    const auto at = static_cast<std::size_t>(
        uniform(random, 0, static_cast<std::int64_t>(topics.events.size()) - 1));
    ScheduledMessage stray = topics.events[at];
    const Event event{static_cast<std::uint16_t>(uniform(random, 0, stray.size.width + 1)),
                      static_cast<std::uint16_t>(chance(random, 10) ? UINT16_MAX : 0),
                      anyStamp(random), true};
    stray.records = toWire({event});
    stray.sequence = 0;
    if (chance(random, 10)) {
      stray.size = {stray.size.width, stray.size.height + 1};
    } else if (chance(random, 10)) {
      stray.size = {0, stray.size.height};
    }
    topics.events.insert(topics.events.begin() + static_cast<std::ptrdiff_t>(at), stray);
  }
}

/// Drops, repeats, delays and shuffles messages of one topic.
void disturb(Random& random, Schedule& topic) {
  Schedule disturbed;
  for (const ScheduledMessage& message : topic) {
    const int copies = chance(random, 5) ? 0 : chance(random, 3) ? 2 : 1;
    disturbed.insert(disturbed.end(), static_cast<std::size_t>(copies), message);
  }
  const std::int64_t longest_ns = uniform(random, 0, 150) * kMs;
  std::int64_t last_ns = INT64_MIN;
  for (ScheduledMessage& message : disturbed) {
    // Over a connection the order stays.
    message.now_ns = std::max(last_ns, message.now_ns + uniform(random, 0, longest_ns));
    last_ns = message.now_ns;
  }
  if (chance(random, 20)) {
    std::vector<std::int64_t> arrivals;
    for (const ScheduledMessage& message : disturbed) {
      arrivals.push_back(message.now_ns);
    }
    std::shuffle(disturbed.begin(), disturbed.end(), random);
    for (std::size_t i = 0; i < disturbed.size(); ++i) {
      disturbed[i].now_ns = arrivals[i];
    }
  }
  topic = std::move(disturbed);
}

}  // namespace

std::int64_t uniform(Random& random, std::int64_t lowest, std::int64_t highest) {
  return lowest +
         static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(highest - lowest + 1));
}

bool chance(Random& random, int percent) {
  return uniform(random, 0, 99) < percent;
}

Schedule undisturbedSchedule(Random& random, const CameraRun& run) {
  return merge(random, cameraTopics(random, run));
}

Schedule disturbedSchedule(Random& random, SensorSize size, PixelFormat format) {
  Schedule schedule;
  CameraRun run;
  run.format = format;
  const std::int64_t runs = uniform(random, 1, 4);
  for (std::int64_t i = 0; i < runs; ++i) {
    run.size = chance(random, 15) ? SensorSize{size.height, size.width} : size;
    // Clocks jump back and ahead between runs.
    run.start_ns =
        chance(random, 30) ? 1000 * kNanosecondsPerSecond : uniform(random, 0, 4'000'000) * kMs;
    Topics topics = cameraTopics(random, run);
    run.first_sequence += static_cast<std::uint32_t>(topics.events.size());
    if (chance(random, 20)) {
      run.first_sequence = 0;
    }
    makeOdd(random, topics);
    if (chance(random, 10)) {
      topics.events.clear();  // a driver whose event stream is not up
    }
    for (Schedule* topic : {&topics.events, &topics.frames, &topics.exposures}) {
      disturb(random, *topic);
    }
    const Schedule part = merge(random, topics);
    schedule.insert(schedule.end(), part.begin(), part.end());
    run.first_arrival_ns = schedule.empty() ? 0 : schedule.back().now_ns;
  }
  return schedule;
}

InputFrame frameOf(const ScheduledMessage& message) {
  InputFrame frame;
  frame.stamp_ns = message.stamp_ns;
  frame.image = {message.pixels->data(), message.size,
                 static_cast<std::size_t>(message.size.width * bytesPerPixel(message.format)),
                 message.format};
  frame.supported = message.supported;
  frame.owner = message.pixels;
  return frame;
}

}  // namespace fast_edi::testing
