/// The pipeline under random schedules: what it does may not depend on how messages interleave and
/// where event arrays begin and end, and its promises hold whatever comes.
#include <algorithm>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <random>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "fast_edi/pipeline/deblurrer.hpp"
#include "support/event_generators.hpp"
#include "support/pipeline_input.hpp"

namespace fast_edi {
namespace {

constexpr std::int64_t kUs = kNanosecondsPerMicrosecond;
constexpr std::int64_t kMs = kNanosecondsPerMillisecond;
constexpr SensorSize kSize{8, 6};
constexpr std::int64_t kZero = 1000 * kNanosecondsPerSecond;

using Random = std::mt19937_64;

std::int64_t uniform(Random& random, std::int64_t lowest, std::int64_t highest) {
  return lowest +
         static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(highest - lowest + 1));
}

bool chance(Random& random, int percent) {
  return uniform(random, 0, 99) < percent;
}

DeblurParameters scheduleParameters() {
  DeblurParameters parameters;
  parameters.thresholds = {0.3, 0.25};
  return parameters;
}

/// One call of the pipeline and when it is made.
struct Arrival {
  std::int64_t now_ns = 0;
  std::function<void(Deblurrer&, std::int64_t now_ns)> deliver;
};

/// What a camera did: frames of varying exposure, and the events meanwhile.
struct Recording {
  struct Shot {
    InputFrame frame;
    std::int32_t exposure_us;
    std::int64_t readout_ns;  ///< instant at which image and exposure message leave the camera
  };
  std::vector<Shot> shots;
  std::vector<Event> events;
};

Recording makeRecording(Random& random, std::int64_t start_ns, int frames,
                        std::int64_t max_exposure_us = 30'000) {
  Recording recording;
  constexpr std::int64_t kPeriod = 40 * kMs;
  for (int i = 0; i < frames; ++i) {
    const auto length_us = static_cast<std::int32_t>(uniform(random, 1'000, max_exposure_us));
    const std::int64_t end_ns = start_ns + (i + 1) * kPeriod - uniform(random, 0, 50) * kUs;
    const std::int64_t begin_ns = end_ns - length_us * kUs;
    const std::int64_t stamp_ns = begin_ns + length_us / 2 * kUs;
    recording.shots.push_back(
        {testing::makeFrame(stamp_ns, kSize, testing::makeGreyImage(kSize, random())), length_us,
         end_ns + 5 * kMs});
  }
  const std::int64_t duration_ns = (frames + 1) * kPeriod;
  recording.events = testing::makeEvents(
      testing::EventScene::kUniform,
      {kSize, static_cast<std::size_t>(duration_ns / (20 * kUs)), start_ns, duration_ns, random()});
  recording.events.front().t_ns = start_ns;
  return recording;
}

/// Cuts events into arrays of random length, each leaving the camera with its last event.
std::vector<Arrival> eventArrivals(const std::vector<Event>& events, Random& random,
                                   std::int64_t max_array_ns, std::uint32_t first_sequence) {
  std::vector<Arrival> arrivals;
  std::uint32_t sequence = first_sequence;
  for (std::size_t begin = 0; begin < events.size();) {
    const std::int64_t until_ns = events[begin].t_ns + uniform(random, 1, max_array_ns);
    std::size_t end = begin + 1;
    while (end < events.size() && events[end].t_ns < until_ns) {
      ++end;
    }
    const std::vector<Event> part(events.begin() + static_cast<std::ptrdiff_t>(begin),
                                  events.begin() + static_cast<std::ptrdiff_t>(end));
    const auto bytes = testing::toWire(part);
    arrivals.push_back({part.back().t_ns, [bytes, sequence](Deblurrer& d, std::int64_t now_ns) {
                          d.addEvents(testing::wireView(bytes), kSize, sequence, now_ns);
                        }});
    ++sequence;
    begin = end;
  }
  return arrivals;
}

Arrival frameArrival(const Recording::Shot& shot) {
  return {shot.readout_ns,
          [frame = shot.frame](Deblurrer& d, std::int64_t now_ns) { d.addFrame(frame, now_ns); }};
}

/// Each delivery, repeated ones too, with an owner of its own, so that outputs can be told apart.
Arrival ownedFrameArrival(const Recording::Shot& shot) {
  return {shot.readout_ns, [frame = shot.frame](Deblurrer& d, std::int64_t now_ns) {
            InputFrame owned = frame;
            owned.owner = std::make_shared<std::shared_ptr<const void>>(frame.owner);
            d.addFrame(owned, now_ns);
          }};
}

Arrival exposureArrival(const Recording::Shot& shot) {
  return {shot.readout_ns + 10 * kUs, [us = shot.exposure_us](Deblurrer& d, std::int64_t now_ns) {
            d.addExposure(us, now_ns);
          }};
}

/// Delays each message at random; within a topic the order stays, as over a connection.
void delay(std::vector<Arrival>& topic, Random& random, std::int64_t max_ns) {
  std::int64_t last_ns = INT64_MIN;
  for (Arrival& arrival : topic) {
    arrival.now_ns = std::max(last_ns, arrival.now_ns + uniform(random, 0, max_ns));
    last_ns = arrival.now_ns;
  }
}

std::vector<Arrival> merge(std::vector<std::vector<Arrival>> topics, Random& random) {
  std::vector<Arrival> all;
  std::shuffle(topics.begin(), topics.end(), random);
  for (const auto& topic : topics) {
    all.insert(all.end(), topic.begin(), topic.end());
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const Arrival& a, const Arrival& b) { return a.now_ns < b.now_ns; });
  return all;
}

TEST(DeblurrerSchedule, OutputDoesNotDependOnInterleavingNorOnTheSplitIntoArrays) {
  for (std::uint64_t recording_seed = 0; recording_seed < 4; ++recording_seed) {
    Random recording_random(recording_seed);
    const Recording recording = makeRecording(recording_random, kZero, 20);
    std::vector<testing::RecordedFrame> expected;
    for (std::uint64_t seed = 0; seed < 15; ++seed) {
      Random random(seed);
      DeblurParameters parameters = scheduleParameters();
      parameters.weighting = recording_seed % 2 == 0 ? Weighting::kTime : Weighting::kCounter;
      testing::RecordingSink sink;
      Deblurrer deblurrer(parameters, sink);

      const std::int64_t max_array_ns = std::int64_t{1} << uniform(random, 10, 25);
      const std::int64_t max_delay_ns = seed == 0 ? 0 : uniform(random, 1, 20) * kMs;
      auto events = eventArrivals(recording.events, random, max_array_ns, 1);
      std::vector<Arrival> frames, exposures;
      for (const auto& shot : recording.shots) {
        frames.push_back(frameArrival(shot));
        exposures.push_back(exposureArrival(shot));
      }
      for (auto* topic : {&events, &frames, &exposures}) {
        delay(*topic, random, max_delay_ns);
      }
      for (const Arrival& arrival : merge({events, frames, exposures}, random)) {
        if (chance(random, 30)) {
          deblurrer.advance(arrival.now_ns);
        }
        arrival.deliver(deblurrer, arrival.now_ns);
      }
      deblurrer.finish();

      ASSERT_EQ(sink.outputs.size(), recording.shots.size()) << "seed " << seed;
      EXPECT_EQ(deblurrer.counters().frames_deblurred, recording.shots.size()) << "seed " << seed;
      EXPECT_EQ(deblurrer.counters().frames_timed_out, 0u) << "seed " << seed;
      for (std::size_t i = 0; i < sink.outputs.size(); ++i) {
        EXPECT_EQ(sink.outputs[i].frame.exposure.length(), recording.shots[i].exposure_us * kUs);
      }
      if (seed == 0) {
        expected = sink.outputs;
      }
      EXPECT_TRUE(sink.outputs == expected) << "recording " << recording_seed << ", seed " << seed;
    }
  }
}

/// Checks after every call what must hold whatever has come.
class InvariantChecker {
 public:
  InvariantChecker(const Deblurrer& deblurrer, const testing::RecordingSink& sink,
                   std::size_t max_events)
      : deblurrer_(deblurrer), sink_(sink), max_events_(max_events) {}

  void check() {
    const DeblurCounters& c = deblurrer_.counters();
    const DeblurStatus status = deblurrer_.status();
    ASSERT_EQ(c.frames_in, c.frames_deblurred + c.framesPassed() + c.frames_suppressed +
                               c.frames_abandoned + status.waiting_frames);
    ASSERT_EQ(c.frames_deblurred + c.framesPassed(), sink_.outputs.size());
    ASSERT_EQ(c.windows_predicted + c.windows_not_predicted, c.frames_deblurred);
    ASSERT_LE(c.frames_still, c.frames_deblurred);
    ASSERT_TRUE(sink_.isBalanced());
    ASSERT_LE(status.buffered_events, max_events_);
    ASSERT_LE(c.events_late + c.events_outside + c.events_glitched + c.events_refused +
                  c.events_repeated + c.events_overflowed + status.buffered_events,
              c.events_in);
    for (; checked_ < sink_.outputs.size(); ++checked_) {
      const OutputFrame& output = sink_.outputs[checked_].frame;
      // Each input frame was given an owner of its own.
      ASSERT_TRUE(owners_.insert(output.input.owner.get()).second) << "two outputs for one frame";
      if (checked_ > 0) {
        const std::int64_t last_ns = sink_.outputs[checked_ - 1].frame.stamp_ns;
        if (output.stamp_ns <= last_ns) {
          ++steps_back_;
        }
      }
    }
    // Stamps go back only where the frames' clock jumped.
    ASSERT_LE(steps_back_, c.frame_time_jumps);
  }

 private:
  const Deblurrer& deblurrer_;
  const testing::RecordingSink& sink_;
  std::size_t max_events_;
  std::size_t checked_ = 0;
  std::uint64_t steps_back_ = 0;
  std::set<const void*> owners_;
};

/// A run with resets of the clocks, lost, repeated and odd messages, and long delays.
std::vector<Arrival> badRun(Random& random) {
  std::vector<Arrival> run;
  std::int64_t run_ns = 0;
  std::uint32_t sequence = 1;
  const int parts = static_cast<int>(uniform(random, 1, 4));
  for (int part = 0; part < parts; ++part) {
    // Sensor time of a part: anywhere, so clocks jump back and ahead between parts.
    const std::int64_t start_ns = chance(random, 30) ? kZero : uniform(random, 0, 4'000'000) * kMs;
    const Recording recording = makeRecording(random, start_ns, 8);
    std::vector<Arrival> events =
        eventArrivals(recording.events, random, uniform(random, 1, 40) * kMs, sequence);
    sequence += static_cast<std::uint32_t>(events.size());
    if (chance(random, 20)) {
      sequence = 0;
    }
    std::vector<Arrival> frames, exposures;
    for (const auto& shot : recording.shots) {
      Recording::Shot odd = shot;
      odd.frame = testing::makeFrame(shot.frame.stamp_ns, kSize, testing::makeGreyImage(kSize, 1));
      if (chance(random, 5)) {
        odd.frame.stamp_ns = uniform(random, 0, 4'000'000) * kMs;
      }
      if (chance(random, 3)) {
        odd.frame = testing::makeFlatFrame(odd.frame.stamp_ns, {8, 7});
      }
      odd.frame.supported = !chance(random, 3);
      if (chance(random, 5)) {
        odd.exposure_us = static_cast<std::int32_t>(uniform(random, -10, 2'000'000));
      }
      frames.push_back(ownedFrameArrival(odd));
      exposures.push_back(exposureArrival(odd));
    }
    // Stray events of any time, alone in their arrays; now and then another sensor size.
    for (int i = 0; i < 3; ++i) {
      const Event stray{static_cast<std::uint16_t>(uniform(random, 0, 9)), 0,
                        uniform(random, 0, 4'000'000) * kMs, true};
      const SensorSize size = chance(random, 10)   ? SensorSize{8, 7}
                              : chance(random, 10) ? SensorSize{0, 6}
                                                   : kSize;
      const auto bytes = testing::toWire({stray});
      const auto at = static_cast<std::size_t>(
          uniform(random, 0, static_cast<std::int64_t>(events.size()) - 1));
      events.insert(events.begin() + static_cast<std::ptrdiff_t>(at),
                    {events[at].now_ns, [bytes, size](Deblurrer& d, std::int64_t now_ns) {
                       d.addEvents(testing::wireView(bytes), size, 0, now_ns);
                     }});
    }
    std::int64_t part_end_ns = run_ns;
    std::vector<std::vector<Arrival>> topics{events, frames, exposures};
    for (auto& topic : topics) {
      std::vector<Arrival> kept;
      for (const Arrival& arrival : topic) {
        const int copies = chance(random, 5) ? 0 : chance(random, 3) ? 2 : 1;
        for (int i = 0; i < copies; ++i) {
          kept.push_back(arrival);
          kept.back().now_ns += run_ns - start_ns;
        }
      }
      delay(kept, random, uniform(random, 0, 150) * kMs);
      if (chance(random, 20)) {
        std::shuffle(kept.begin(), kept.end(), random);
      }
      for (const Arrival& arrival : kept) {
        part_end_ns = std::max(part_end_ns, arrival.now_ns);
      }
      topic = kept;
    }
    for (const Arrival& arrival : merge(topics, random)) {
      run.push_back(arrival);
    }
    run_ns = part_end_ns;
  }
  return run;
}

TEST(DeblurrerSchedule, ItsPromisesHoldWhateverComes) {
  std::uint64_t deblurred = 0;
  std::map<std::size_t, std::uint64_t> passed;
  for (std::uint64_t seed = 0; seed < 150; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    DeblurParameters parameters = scheduleParameters();
    parameters.max_buffered_events = static_cast<std::size_t>(uniform(random, 1000, 100'000));
    parameters.exposure_time_ns = chance(random, 50) ? 10 * kMs : 0;
    parameters.exposure_source =
        chance(random, 80) ? ExposureSource::kTopic : ExposureSource::kParameter;
    parameters.reference = static_cast<ExposureInstant>(uniform(random, 0, 2));
    parameters.time_offset_ns = uniform(random, -5, 5) * kMs;
    testing::RecordingSink sink;
    Deblurrer deblurrer(parameters, sink);
    InvariantChecker invariants(deblurrer, sink, parameters.max_buffered_events);

    for (const Arrival& arrival : badRun(random)) {
      if (chance(random, 20)) {
        deblurrer.advance(arrival.now_ns);
      }
      if (chance(random, 1)) {
        parameters.thresholds.on = 0.1 * static_cast<double>(uniform(random, 1, 5));
        parameters.passthrough = chance(random, 20);
        deblurrer.setParameters(parameters);
      }
      arrival.deliver(deblurrer, arrival.now_ns);
      invariants.check();
      if (HasFatalFailure()) {
        return;
      }
    }
    deblurrer.finish();
    invariants.check();
    EXPECT_EQ(deblurrer.status().waiting_frames, 0u);
    deblurred += deblurrer.counters().frames_deblurred;
    for (std::size_t i = 0; i < kPassReasonCount; ++i) {
      passed[i] += deblurrer.counters().frames_passed[i];
    }
  }
  // The runs reached what they are meant to reach.
  EXPECT_GT(deblurred, 500u);
  for (const auto& [index, count] : passed) {
    const auto reason = static_cast<PassReason>(index);
    if (reason != PassReason::kTooManyWaiting) {  // its runs are longer: deblurrer_test.cpp
      EXPECT_GT(count, 0u) << toString(reason);
    }
  }
}

/// Everything that may change from frame to frame, at random. Windows of consecutive frames are far
/// enough apart for all of it: none reaches back to before the start of the one before.
DeblurParameters anyParameters(Random& random) {
  DeblurParameters parameters;
  parameters.refine_contrast = false;  // what is learned depends on the frames before
  parameters.refine_delay = false;
  parameters.thresholds = {0.1 * static_cast<double>(uniform(random, 1, 5)),
                           0.1 * static_cast<double>(uniform(random, 1, 5))};
  parameters.weighting = chance(random, 70) ? Weighting::kTime : Weighting::kCounter;
  parameters.reference = static_cast<ExposureInstant>(uniform(random, 0, 2));
  parameters.stamp_reference = static_cast<ExposureInstant>(uniform(random, 0, 2));
  parameters.exposure_source =
      chance(random, 60) ? ExposureSource::kTopic : ExposureSource::kParameter;
  parameters.exposure_time_ns = uniform(random, 1, 15) * kMs;
  parameters.time_offset_ns = uniform(random, -2'000, 2'000) * kUs;
  parameters.close_timeout_ns = uniform(random, 50, 200) * kMs;
  parameters.filter.enabled = chance(random, 70);
  parameters.filter.gain.despeckle = chance(random, 50);
  parameters.filter.gain.smooth = chance(random, 50);
  parameters.filter.frame_noise = chance(random, 50);
  parameters.filter.frame_noise_kept = 0.1 * static_cast<double>(uniform(random, 0, 10));
  parameters.filter.frame_noise_dn = static_cast<double>(uniform(random, 1, 5));
  parameters.filter.reblur = chance(random, 50);
  parameters.filter.motion = chance(random, 50);
  parameters.passthrough = chance(random, 15);
  return parameters;
}

/// Outputs by the frame that they are of.
std::map<const void*, testing::RecordedFrame> byFrame(const testing::RecordingSink& sink) {
  std::map<const void*, testing::RecordedFrame> outputs;
  for (const testing::RecordedFrame& output : sink.outputs) {
    outputs.emplace(output.frame.input.owner.get(), output);
  }
  return outputs;
}

std::map<const void*, testing::RecordedFrame> deblurredAfresh(const DeblurParameters& parameters,
                                                              const std::vector<Arrival>& run) {
  testing::RecordingSink sink;
  Deblurrer deblurrer(parameters, sink);
  for (const Arrival& arrival : run) {
    arrival.deliver(deblurrer, arrival.now_ns);
  }
  deblurrer.finish();
  return byFrame(sink);
}

TEST(DeblurrerSchedule, AfterAChangeOfParametersFramesAreThoseOfAFreshPipeline) {
  std::uint64_t deblurred = 0;
  std::uint64_t waiting = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const Recording recording = makeRecording(random, kZero, 12, 15'000);
    std::vector<Arrival> frames, exposures;
    for (const auto& shot : recording.shots) {
      frames.push_back(frameArrival(shot));
      exposures.push_back(exposureArrival(shot));
    }
    const std::vector<Arrival> run =
        merge({eventArrivals(recording.events, random, uniform(random, 1, 20) * kMs, 1), frames,
               exposures},
              random);
    const auto isExposure = [&exposures](const Arrival& arrival) {
      return std::any_of(exposures.begin(), exposures.end(), [&arrival](const Arrival& exposure) {
        return exposure.now_ns == arrival.now_ns;
      });
    };

    DeblurParameters parameters = anyParameters(random);
    testing::RecordingSink sink;
    Deblurrer deblurrer(parameters, sink);
    auto expected = deblurredAfresh(parameters, run);
    std::int64_t changed_ns = INT64_MIN;
    std::int64_t source_changed_ns = INT64_MIN;
    std::size_t checked = 0;
    const auto checkNew = [&] {
      for (; checked < sink.outputs.size(); ++checked) {
        const testing::RecordedFrame& output = sink.outputs[checked];
        const auto shot = std::find_if(recording.shots.begin(), recording.shots.end(),
                                       [&output](const Recording::Shot& candidate) {
                                         return candidate.frame.owner == output.frame.input.owner;
                                       });
        const bool waited = shot->readout_ns < changed_ns;
        // How long a frame was exposed that was there before, the old source alone has said.
        if (shot->readout_ns < source_changed_ns) {
          continue;
        }
        ASSERT_EQ(expected.count(shot->frame.owner.get()), 1u);
        EXPECT_TRUE(output == expected.at(shot->frame.owner.get())) << "output " << checked;
        deblurred += output.frame.deblurred && changed_ns != INT64_MIN ? 1 : 0;
        waiting += output.frame.deblurred && waited ? 1 : 0;
      }
    };
    for (const Arrival& arrival : run) {
      // Not between an image and its message, which then would be taken for that of the next.
      if (chance(random, 12) && !isExposure(arrival)) {
        const DeblurParameters before = parameters;
        parameters = anyParameters(random);
        deblurrer.setParameters(parameters);
        expected = deblurredAfresh(parameters, run);
        changed_ns = arrival.now_ns;
        if (parameters.exposure_source != before.exposure_source) {
          source_changed_ns = changed_ns;
        }
      }
      arrival.deliver(deblurrer, arrival.now_ns);
      checkNew();
      if (HasFatalFailure()) {
        return;
      }
    }
    deblurrer.finish();
    checkNew();
    EXPECT_EQ(sink.outputs.size(), recording.shots.size());
  }
  // The runs reached what they are meant to reach.
  EXPECT_GT(deblurred, 200u);
  EXPECT_GT(waiting, 5u);
}

TEST(DeblurrerSchedule, TheSameCallsGiveTheSameImages) {
  std::vector<testing::RecordedFrame> outputs[2];
  for (auto& output : outputs) {
    Random random(7);
    testing::RecordingSink sink;
    Deblurrer deblurrer(scheduleParameters(), sink);
    for (const Arrival& arrival : badRun(random)) {
      arrival.deliver(deblurrer, arrival.now_ns);
    }
    deblurrer.finish();
    output = sink.outputs;
  }
  ASSERT_EQ(outputs[0].size(), outputs[1].size());
  for (std::size_t i = 0; i < outputs[0].size(); ++i) {
    EXPECT_EQ(outputs[0][i].frame.stamp_ns, outputs[1][i].frame.stamp_ns);
    EXPECT_EQ(outputs[0][i].pixels, outputs[1][i].pixels);
  }
}

}  // namespace
}  // namespace fast_edi
