#include "node/node_diagnostics.hpp"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "node/diagnostic_value.hpp"
#include "support/comma_locale.hpp"

namespace fast_edi {
namespace {

using diagnostic_msgs::DiagnosticStatus;
using diagnostic_updater::DiagnosticStatusWrapper;
using ::testing::HasSubstr;
using testing::value;

constexpr std::int64_t kSecond_ns = kNanosecondsPerSecond;

class NodeDiagnosticsTest : public ::testing::Test {
 protected:
  NodeDiagnosticsTest() {
    now_.time_ns = 100 * kSecond_ns;
    now_.listening = true;
    now_.listening_since_ns = 99 * kSecond_ns;
    now_.last_frame_ns = now_.time_ns;
    now_.last_events_ns = now_.time_ns;
    now_.status.sensor_size = {346, 260};
    diagnostics_.update(now_);
  }

  /// One second later, with everything that arrives arriving.
  void tick() {
    now_.time_ns += kSecond_ns;
    now_.last_frame_ns = now_.time_ns;
    now_.last_events_ns = now_.time_ns;
  }

  DiagnosticStatusWrapper report() {
    diagnostics_.update(now_);
    DiagnosticStatusWrapper status;
    diagnostics_.fill(close_latency_, output_latency_, status);
    return status;
  }

  NodeDiagnostics diagnostics_{
      {"/dvs/events", "/dvs/image_raw", "/dvs/exposure", "/driver/parameter_updates"}};
  NodeSnapshot now_;
  LatencyRecord close_latency_;
  LatencyRecord output_latency_;
};

TEST_F(NodeDiagnosticsTest, SaysIdleWhenNobodyListens) {
  now_.listening = false;
  const auto status = report();
  EXPECT_EQ(status.level, DiagnosticStatus::OK);
  EXPECT_THAT(status.message, HasSubstr("idle"));
}

TEST_F(NodeDiagnosticsTest, SaysWhyTheConfigurationWasRefused) {
  now_.listening = false;
  now_.configuration_error = "wieghting: unknown key";
  const auto status = report();
  EXPECT_EQ(status.level, DiagnosticStatus::ERROR);
  EXPECT_THAT(status.message, HasSubstr("wieghting: unknown key"));
}

TEST_F(NodeDiagnosticsTest, WritesNumbersTheSameUnderEveryLocale) {
  tick();
  now_.counters.events_in = 13'000'000;
  now_.thresholds = {0.26, 0.24};
  now_.last_frame_ns = now_.time_ns - 5 * kSecond_ns / 2;
  const testing::CommaLocale comma;
  const auto status = report();
  EXPECT_EQ(value(status, "Events in"), "13000000");
  EXPECT_EQ(value(status, "Contrast threshold ON"), "0.260000");
  EXPECT_EQ(value(status, "Event rate [Mev/s]"), "13.000");
  EXPECT_THAT(status.message, HasSubstr("2.5 s"));
}

TEST_F(NodeDiagnosticsTest, TurnsCountsIntoRates) {
  tick();
  now_.counters.frames_in = 25;
  now_.counters.events_in = 2'500'000;
  now_.counters.event_arrays = 30;
  now_.frames_out = 24;
  report();
  now_.time_ns += kSecond_ns;
  tick();  // two seconds
  now_.counters.frames_in += 50;
  now_.counters.events_in += 3'000'000;
  now_.counters.event_arrays += 60;
  now_.frames_out += 40;
  const auto status = report();
  EXPECT_EQ(status.level, DiagnosticStatus::OK) << status.message;
  EXPECT_EQ(value(status, "Frame rate in [Hz]"), "25.00");
  EXPECT_EQ(value(status, "Frame rate out [Hz]"), "20.00");
  EXPECT_EQ(value(status, "Event rate [Mev/s]"), "1.500");
  EXPECT_EQ(value(status, "Event array rate [Hz]"), "30.0");
}

TEST_F(NodeDiagnosticsTest, ShowsSilence) {
  now_.time_ns += 3 * kSecond_ns;
  const auto status = report();
  EXPECT_EQ(status.level, DiagnosticStatus::ERROR);
  EXPECT_THAT(status.message, HasSubstr("no frame on /dvs/image_raw for 3.0 s"));
  EXPECT_THAT(status.message, HasSubstr("no event array on /dvs/events for 3.0 s"));
}

TEST_F(NodeDiagnosticsTest, SaysThatTheMasterIsMissing) {
  tick();
  now_.master_missing = true;
  const auto status = report();
  EXPECT_EQ(status.level, DiagnosticStatus::ERROR);
  EXPECT_THAT(status.message, HasSubstr("the ROS master cannot be reached"));
}

TEST_F(NodeDiagnosticsTest, CountsSilenceFromTheSubscription) {
  now_.last_frame_ns = 0;
  now_.listening_since_ns = now_.time_ns;
  tick();
  now_.last_frame_ns = 0;
  EXPECT_EQ(report().level, DiagnosticStatus::OK);
}

TEST_F(NodeDiagnosticsTest, SaysWhyFramesArePassedThrough) {
  tick();
  now_.counters.frames_passed[static_cast<std::size_t>(PassReason::kExposureUnknown)] = 3;
  now_.counters.frames_passed[static_cast<std::size_t>(PassReason::kUnsupportedEncoding)] = 2;
  now_.unsupported_reason = "encoding \"32FC1\", expected mono8";
  auto status = report();
  EXPECT_EQ(status.level, DiagnosticStatus::WARN);
  EXPECT_THAT(status.message, HasSubstr("3 frame(s) on /dvs/image_raw passed through"));
  EXPECT_THAT(status.message, HasSubstr("/dvs/exposure"));
  EXPECT_THAT(status.message, HasSubstr("exposure_time_us"));
  EXPECT_THAT(status.message, HasSubstr("encoding \"32FC1\""));
  tick();
  status = report();
  EXPECT_EQ(status.level, DiagnosticStatus::OK) << "old news: " << status.message;
  EXPECT_EQ(value(status,
                  std::string("Frames passed through: ") + toString(PassReason::kExposureUnknown)),
            "3");
}

TEST_F(NodeDiagnosticsTest, NamesBothClocksWhereTheyDiffer) {
  tick();
  now_.counters.frames_passed[static_cast<std::size_t>(PassReason::kClocksDiffer)] = 2;
  now_.status.differing_clocks = {2 * kNanosecondsPerSecond, 1'234'567'890};
  const auto status = report();
  EXPECT_EQ(status.level, DiagnosticStatus::WARN);
  EXPECT_THAT(status.message,
              HasSubstr("2 frame(s) on /dvs/image_raw passed through unchanged: clocks differ"));
  EXPECT_THAT(status.message, HasSubstr("stamped 2.000 s, the newest event 1.234 s"));
  EXPECT_EQ(value(status, "Frames passed through: clocks differ"), "2");
}

TEST_F(NodeDiagnosticsTest, DoesNotComplainOfWhatTheUserAskedFor) {
  tick();
  now_.counters.frames_passed[static_cast<std::size_t>(PassReason::kPassthroughParameter)] = 3;
  EXPECT_EQ(report().level, DiagnosticStatus::OK);
}

TEST_F(NodeDiagnosticsTest, DoesNotComplainOfFramesThatNobodyWaitsForAnyMore) {
  tick();
  now_.counters.frames_abandoned = 3;
  const auto status = report();
  EXPECT_EQ(status.level, DiagnosticStatus::OK) << status.message;
  EXPECT_EQ(value(status, "Frames abandoned"), "3");
}

TEST_F(NodeDiagnosticsTest, ComplainsOfEveryKindOfLoss) {
  struct Case {
    std::uint64_t DeblurCounters::*counter;
    const char* expected;
  };
  for (const Case& c : {Case{&DeblurCounters::events_late, "older than the newest"},
                        Case{&DeblurCounters::events_outside, "346x260"},
                        Case{&DeblurCounters::events_glitched, "time jump"},
                        Case{&DeblurCounters::events_overflowed, "max_buffered_events"},
                        Case{&DeblurCounters::event_arrays_refused, "1 to 32767"},
                        Case{&DeblurCounters::event_arrays_repeated, "published twice"},
                        Case{&DeblurCounters::event_array_gaps, "header.seq"},
                        Case{&DeblurCounters::event_restarts, "restart(s) of the publisher"},
                        Case{&DeblurCounters::event_time_jumps, "/dvs/events"},
                        Case{&DeblurCounters::frame_time_jumps, "/dvs/image_raw"},
                        Case{&DeblurCounters::size_changes, "346x260"},
                        Case{&DeblurCounters::frames_suppressed, "no output"},
                        Case{&DeblurCounters::exposures_refused, "/dvs/exposure"},
                        Case{&DeblurCounters::exposures_surplus, "/dvs/exposure"},
                        Case{&DeblurCounters::exposures_missing, "/dvs/exposure"},
                        Case{&DeblurCounters::pixels_out_of_range, "pixel"}}) {
    tick();
    now_.counters.*c.counter += 5;
    const auto status = report();
    EXPECT_EQ(status.level, DiagnosticStatus::WARN) << c.expected;
    EXPECT_THAT(status.message, HasSubstr(c.expected));
    ASSERT_EQ(diagnostics_.complaints().size(), 1u);
    EXPECT_EQ(diagnostics_.complaints()[0].text.substr(0, 2), "5 ");
  }
}

TEST_F(NodeDiagnosticsTest, ComplainsOfWhatTheNodeItselfRefused) {
  tick();
  now_.frames_malformed = 1;
  now_.malformed_reason = "step 3 bytes, expected at least 4";
  now_.frames_missing = 7;
  now_.messages_repeated = 6;
  now_.camera_infos_refused = 1;
  now_.camera_info_refusal = "K holds";
  now_.bias_updates_refused = 1;
  now_.bias_refusal = "OffBn";
  now_.internal_errors = 1;
  now_.internal_error = "std::bad_alloc";
  now_.event_suspensions = 2;
  const auto status = report();
  EXPECT_THAT(status.message,
              HasSubstr("2 time(s) that no events on /dvs/events were received for 2.0 s"));
  EXPECT_EQ(value(status, "Event suspensions"), "2");
  EXPECT_THAT(status.message, HasSubstr("step 3 bytes"));
  EXPECT_THAT(status.message, HasSubstr("7 frame(s)"));
  EXPECT_THAT(status.message, HasSubstr("6 message(s) on /dvs/events"));
  EXPECT_EQ(value(status, "Messages repeated"), "6");
  EXPECT_THAT(status.message, HasSubstr("K holds"));
  EXPECT_THAT(status.message, HasSubstr("/driver/parameter_updates"));
  EXPECT_THAT(status.message, HasSubstr("std::bad_alloc"));
}

TEST_F(NodeDiagnosticsTest, ReportsLatenciesAndContrast) {
  for (std::int64_t i = 1; i <= 100; ++i) {
    close_latency_.add(i * kNanosecondsPerMillisecond);
  }
  now_.thresholds = {0.26, 0.24};
  now_.contrast_origin = "biases";
  now_.status.thresholds = {0.27, 0.23};
  now_.status.event_delay_ns = 1'500'000;
  const auto status = report();
  EXPECT_EQ(value(status, "Close latency p50 [ms]"), "50.000");
  EXPECT_EQ(value(status, "Close latency p99 [ms]"), "99.000");
  EXPECT_EQ(value(status, "Contrast threshold ON"), "0.260000");
  EXPECT_EQ(value(status, "Contrast threshold OFF"), "0.240000");
  EXPECT_EQ(value(status, "Contrast from"), "biases");
  EXPECT_EQ(value(status, "Contrast threshold ON, learned"), "0.270000");
  EXPECT_EQ(value(status, "Contrast threshold OFF, learned"), "0.230000");
  EXPECT_EQ(value(status, "Event delay, learned [ms]"), "1.500");
}

}  // namespace
}  // namespace fast_edi
