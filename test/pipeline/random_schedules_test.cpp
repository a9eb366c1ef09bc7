/// The pipeline's promises under thousands of random schedules. FAST_EDI_SCHEDULES sets how many.
#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "fast_edi/pipeline/deblurrer.hpp"
#include "support/event_generators.hpp"
#include "support/pipeline_input.hpp"
#include "support/random_schedule.hpp"
#include "support/schedule_checker.hpp"
#include "support/schedule_count.hpp"

namespace fast_edi {
namespace {

using testing::chance;
using testing::MessageKind;
using testing::Random;
using testing::Schedule;
using testing::ScheduledMessage;
using testing::uniform;

constexpr std::int64_t kMs = kNanosecondsPerMillisecond;
/// Enough pixels to learn from.
constexpr SensorSize kSize{10, 9};
constexpr std::uint64_t kSchedules = 300;

PixelFormat anyFormat(Random& random) {
  constexpr std::array<PixelFormat, 8> kFormats{
      PixelFormat::kMono8,        PixelFormat::kBayer8,       PixelFormat::kMono16,
      PixelFormat::kColour8,      PixelFormat::kBayer16,      PixelFormat::kColour16,
      PixelFormat::kColourAlpha8, PixelFormat::kColourAlpha16};
  return chance(random, 60) ? PixelFormat::kMono8
                            : kFormats[static_cast<std::size_t>(uniform(random, 0, 7))];
}

DeblurParameters anyParameters(Random& random) {
  DeblurParameters parameters;
  parameters.thresholds = {0.1 * static_cast<double>(uniform(random, 1, 5)), 0.25};
  parameters.weighting = chance(random, 80) ? Weighting::kTime : Weighting::kCounter;
  // Half of the time output stamps are the input's, which makes the checks exact.
  parameters.stamp_reference = static_cast<ExposureInstant>(uniform(random, 0, 2));
  parameters.reference = chance(random, 50) ? parameters.stamp_reference
                                            : static_cast<ExposureInstant>(uniform(random, 0, 2));
  parameters.exposure_time_ns = chance(random, 50) ? 10 * kMs : 0;
  parameters.exposure_source =
      chance(random, 80) ? ExposureSource::kTopic : ExposureSource::kParameter;
  parameters.time_offset_ns = uniform(random, -5, 5) * kMs;
  parameters.filter.enabled = chance(random, 70);
  parameters.refine_contrast = chance(random, 50);
  parameters.refine_delay = chance(random, 50);
  parameters.latent.per_exposure = chance(random, 20) ? 3 : 0;
  return parameters;
}

void deliver(const ScheduledMessage& message, Deblurrer& deblurrer) {
  switch (message.kind) {
    case MessageKind::kEvents:
      deblurrer.addEvents(testing::wireView(message.records), message.size, message.sequence,
                          message.now_ns);
      break;
    case MessageKind::kFrame:
      deblurrer.addFrame(testing::frameOf(message), message.now_ns);
      break;
    case MessageKind::kExposure:
      deblurrer.addExposure(message.exposure_us, message.now_ns);
      break;
  }
}

/// The same with \p checker told beforehand.
void deliverChecked(const ScheduledMessage& message, Deblurrer& deblurrer,
                    testing::ScheduleChecker& checker) {
  if (message.kind == MessageKind::kFrame) {
    deblurrer.addFrame(checker.expect(testing::frameOf(message)), message.now_ns);
    return;
  }
  if (message.kind == MessageKind::kEvents) {
    checker.expectEvents(message.records.size() / kWireEventBytes);
  }
  deliver(message, deblurrer);
}

TEST(RandomSchedules, ThePromisesHoldWhateverComes) {
  DeblurCounters total;
  const std::uint64_t schedules = testing::scheduleCount(kSchedules);
  for (std::uint64_t seed = 0; seed < schedules; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    DeblurParameters parameters = anyParameters(random);
    parameters.max_buffered_events = static_cast<std::size_t>(uniform(random, 1000, 100'000));
    testing::RecordingSink sink;
    sink.wants_latent_images = chance(random, 50);
    Deblurrer deblurrer(parameters, sink);
    testing::ScheduleChecker checker(deblurrer, sink);

    for (const ScheduledMessage& message :
         testing::disturbedSchedule(random, kSize, anyFormat(random))) {
      if (chance(random, 20)) {
        deblurrer.advance(message.now_ns);
      }
      if (chance(random, 1)) {
        parameters.thresholds.on = 0.1 * static_cast<double>(uniform(random, 1, 5));
        parameters.passthrough = chance(random, 20);
        deblurrer.setParameters(parameters);
      }
      if (uniform(random, 0, 999) == 0) {
        checker.expectPause();
        deblurrer.pause();
      }
      deliverChecked(message, deblurrer, checker);
      ASSERT_EQ(checker.fault(), "");
    }
    deblurrer.finish();
    ASSERT_EQ(checker.faultAtEnd(), "");

    const DeblurCounters& counters = deblurrer.counters();
    ASSERT_EQ(counters.pixels_out_of_range, 0u);
    total.frames_deblurred += counters.frames_deblurred;
    total.frames_suppressed += counters.frames_suppressed;
    total.event_time_jumps += counters.event_time_jumps;
    total.frame_time_jumps += counters.frame_time_jumps;
    total.size_changes += counters.size_changes;
    total.events_overflowed += counters.events_overflowed;
    total.exposures_surplus += counters.exposures_surplus;
    total.exposures_missing += counters.exposures_missing;
    total.calibration_fits += counters.calibration_fits;
    total.latent_images += counters.latent_images;
    for (std::size_t i = 0; i < kPassReasonCount; ++i) {
      total.frames_passed[i] += counters.frames_passed[i];
    }
  }
  // The schedules reached what they are meant to reach.
  EXPECT_GT(total.frames_deblurred, schedules);
  for (const std::uint64_t count :
       {total.frames_suppressed, total.event_time_jumps, total.frame_time_jumps, total.size_changes,
        total.events_overflowed, total.exposures_surplus, total.exposures_missing,
        total.calibration_fits, total.latent_images}) {
    EXPECT_GT(count, schedules / 100);
  }
  for (std::size_t i = 0; i < kPassReasonCount; ++i) {
    if (static_cast<PassReason>(i) == PassReason::kTooManyWaiting) {
      continue;  // takes more frames than a schedule has
    }
    EXPECT_GT(total.frames_passed[i], schedules / 100) << toString(static_cast<PassReason>(i));
  }
}

/// How an undisturbed run follows a disturbed one.
enum class Recovery {
  kClockGoesOn,  ///< only where nothing is learned from the recording
  kTimeJump,
  kSizeChange,
  kPause,
};

/// A sensor time at which a camera can go on after \p schedule: some seconds after the last array
/// that is no stray event, and not near any stray one, which would make everything late. Output
/// stamps reach an exposure of up to a second further than a frame's.
std::int64_t timeAfter(const Schedule& schedule) {
  constexpr std::int64_t kPause_ns = 3 * kNanosecondsPerSecond;
  std::vector<std::int64_t> stamps;
  std::int64_t start_ns = 0;
  for (const ScheduledMessage& message : schedule) {
    if (message.kind == MessageKind::kFrame) {
      stamps.push_back(message.stamp_ns);
    } else if (message.kind == MessageKind::kEvents) {
      const WireEvents events = testing::wireView(message.records);
      stamps.push_back(decodeWireEvent(events.record(events.count - 1)).t_ns);
      start_ns = events.count > 1 ? stamps.back() + kPause_ns : start_ns;
    }
  }
  std::sort(stamps.begin(), stamps.end());
  for (const std::int64_t stamp_ns : stamps) {
    if (stamp_ns >= start_ns - kPause_ns && stamp_ns < start_ns + kPause_ns) {
      start_ns = stamp_ns + kPause_ns;
    }
  }
  return start_ns;
}

/// What came out for each frame, by the frame's pixels.
std::map<const void*, testing::RecordedFrame> byFrame(
    const std::vector<testing::RecordedFrame>& outputs) {
  std::map<const void*, testing::RecordedFrame> found;
  for (const testing::RecordedFrame& output : outputs) {
    found.emplace(output.frame.input.owner.get(), output);
  }
  return found;
}

TEST(RandomSchedules, UndisturbedFramesAreThoseOfAFreshInstance) {
  std::uint64_t compared = 0;
  std::uint64_t learned = 0;
  const std::uint64_t schedules = testing::scheduleCount(kSchedules);
  for (std::uint64_t number = 0; number <= schedules; ++number) {
    // One that few others resemble: the first frame waits for a jump to be confirmed, and what was
    // learned before must not shift its window.
    constexpr std::uint64_t kTellingSeed = 2677;
    const std::uint64_t seed = number < schedules ? number : kTellingSeed;
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    DeblurParameters parameters = anyParameters(random);
    const bool learns =
        parameters.filter.enabled && (parameters.refine_contrast || parameters.refine_delay);
    const auto recovery = static_cast<Recovery>(uniform(random, learns ? 1 : 0, 3));
    const PixelFormat format = anyFormat(random);
    testing::RecordingSink sink;
    Deblurrer deblurrer(parameters, sink);
    std::int64_t now_ns = 0;
    const Schedule disturbed = testing::disturbedSchedule(random, kSize, format);
    for (const ScheduledMessage& message : disturbed) {
      deliver(message, deblurrer);
      now_ns = message.now_ns;
    }

    // A second without messages, in which whatever waits runs out of time.
    for (int i = 0; i < 10; ++i) {
      now_ns += 100 * kMs;
      deblurrer.advance(now_ns);
    }
    testing::CameraRun run;
    run.size = recovery == Recovery::kSizeChange ? SensorSize{12, 11} : kSize;
    run.format = format;
    run.start_ns = recovery == Recovery::kTimeJump ? 8'000 * kNanosecondsPerSecond  //
                                                   : timeAfter(disturbed);
    run.first_arrival_ns = now_ns;
    run.first_sequence = 1'000'000;
    if (recovery == Recovery::kPause) {
      deblurrer.pause();
    }
    const Schedule undisturbed = testing::undisturbedSchedule(random, run);
    sink.outputs.clear();
    testing::RecordingSink fresh_sink;
    Deblurrer fresh(parameters, fresh_sink);
    for (const ScheduledMessage& message : undisturbed) {
      deliver(message, deblurrer);
      deliver(message, fresh);
    }
    deblurrer.finish();
    fresh.finish();

    const auto outputs = byFrame(sink.outputs);
    for (const testing::RecordedFrame& expected : fresh_sink.outputs) {
      // A frame whose exposure began before the first event of the run is not undisturbed.
      const bool whole =
          expected.frame.exposure.start_ns + parameters.time_offset_ns >= run.start_ns;
      if (!expected.frame.deblurred || !whole) {
        continue;
      }
      const auto output = outputs.find(expected.frame.input.owner.get());
      ASSERT_NE(output, outputs.end());
      ASSERT_TRUE(output->second.frame.deblurred)
          << toString(output->second.frame.pass_reason) << ", frame stamped "
          << expected.frame.input.stamp_ns << ", recovery " << static_cast<int>(recovery);
      ASSERT_TRUE(output->second == expected);
      ++compared;
    }
    learned += fresh.counters().calibration_fits;
  }
  EXPECT_GT(compared, 3 * schedules);
  EXPECT_GT(learned, schedules / 10);
}

}  // namespace
}  // namespace fast_edi
