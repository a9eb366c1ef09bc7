#include "stream_node/stream_diagnostics.hpp"

#include <gmock/gmock.h>

#include "fast_edi/base/types.hpp"
#include "node/diagnostic_value.hpp"

namespace fast_edi {
namespace {

using diagnostic_msgs::DiagnosticStatus;
using diagnostic_updater::DiagnosticStatusWrapper;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::value;

class StreamDiagnosticsTest : public ::testing::Test {
 protected:
  StreamDiagnosticsTest() {
    now_.time_ns = 100 * kNanosecondsPerSecond;
    now_.streams = {{StreamKind::kEvents, "127.0.0.1:7777", {}},
                    {StreamKind::kFrames, "/tmp/frames.sock", {}}};
    for (StreamReport& stream : now_.streams) {
      stream.status.connected = true;
      stream.status.connections = 1;
    }
    events().stream = {StreamKind::kEvents, "events", "DAVIS346_1", {346, 260}};
    diagnostics_.update(now_);
  }

  StreamStatus& events() { return now_.streams[0].status; }
  StreamStatus& frames() { return now_.streams[1].status; }

  /// Half a second later.
  DiagnosticStatusWrapper report() {
    now_.time_ns += kNanosecondsPerSecond / 2;
    diagnostics_.update(now_);
    DiagnosticStatusWrapper status;
    diagnostics_.fill(status);
    return status;
  }

  StreamDiagnostics diagnostics_;
  StreamSnapshot now_;
};

TEST_F(StreamDiagnosticsTest, TellsOfNewConnections) {
  EXPECT_THAT(diagnostics_.news(),
              ElementsAre("connected: events of 127.0.0.1:7777, DAVIS346_1, 346x260",
                          "connected: frames of /tmp/frames.sock"));
  report();
  EXPECT_THAT(diagnostics_.news(), IsEmpty()) << "told already";
}

TEST_F(StreamDiagnosticsTest, CountsAndRates) {
  events().items = 50'000;
  events().packets = 10;
  events().bytes = 1'000'000;
  const DiagnosticStatusWrapper status = report();
  EXPECT_EQ(status.level, DiagnosticStatus::OK);
  EXPECT_EQ(status.message, "receiving events, frames");
  EXPECT_EQ(value(status, "events: server"), "127.0.0.1:7777");
  EXPECT_EQ(value(status, "events: connected"), "yes");
  EXPECT_EQ(value(status, "events: rate [1/s]"), "100000.0");
  EXPECT_EQ(value(status, "events: data [MB/s]"), "2.000");
  EXPECT_EQ(value(status, "events: received"), "50000");
  EXPECT_EQ(value(status, "frames: packets"), "0");
  EXPECT_EQ(value(report(), "events: rate [1/s]"), "0.0") << "none since";
}

TEST_F(StreamDiagnosticsTest, WarnsOnceOfWhatHappened) {
  events().cuts = 2;
  events().stalls = 1;
  events().connections = 3;
  events().cut = "nothing came for 2.0 s";
  frames().damaged = 1;
  frames().damage = "packet 3: LZ4 frame is cut";
  now_.frames_without_exposure = 4;
  now_.frames_without_calibration = 5;
  const DiagnosticStatusWrapper status = report();
  EXPECT_EQ(status.level, DiagnosticStatus::WARN);
  EXPECT_THAT(status.message, HasSubstr("2 connection(s) for events of 127.0.0.1:7777 ended: "
                                        "nothing came for 2.0 s"));
  EXPECT_THAT(status.message, HasSubstr("1 place(s) in frames of /tmp/frames.sock could not be "
                                        "read: packet 3: LZ4 frame is cut"));
  EXPECT_THAT(status.message, HasSubstr("4 frame(s) came without the start and end"));
  EXPECT_THAT(status.message, HasSubstr("5 frame(s) have another size than the calibration"));
  EXPECT_EQ(diagnostics_.complaints().size(), 4U);
  EXPECT_EQ(value(status, "events: cuts"), "2");
  EXPECT_EQ(value(status, "events: stalls"), "1");
  EXPECT_EQ(report().level, DiagnosticStatus::OK);
}

TEST_F(StreamDiagnosticsTest, AStreamThatIsMissingIsAnError) {
  events().connected = false;
  events().fault = "cannot connect: Connection refused";
  const DiagnosticStatusWrapper status = report();
  EXPECT_EQ(status.level, DiagnosticStatus::ERROR);
  EXPECT_THAT(status.message,
              HasSubstr("no events of 127.0.0.1:7777: cannot connect: Connection refused"));
  EXPECT_EQ(value(status, "events: connected"), "no: cannot connect: Connection refused");
  EXPECT_EQ(report().level, DiagnosticStatus::ERROR) << "as long as it lasts";
}

TEST_F(StreamDiagnosticsTest, AFirstAttemptIsNoComplaintYet) {
  events() = StreamStatus{};
  const DiagnosticStatusWrapper status = report();
  EXPECT_EQ(status.level, DiagnosticStatus::WARN);
  EXPECT_THAT(status.message, HasSubstr("connecting: events of 127.0.0.1:7777"));
  EXPECT_EQ(value(status, "events: connected"), "no: connecting");
  EXPECT_THAT(diagnostics_.complaints(), IsEmpty()) << "nothing to be logged";
}

TEST_F(StreamDiagnosticsTest, ARefusedConfigurationIsAnError) {
  StreamSnapshot refused;
  refused.configuration_error = "events_port: found 'x'";
  StreamDiagnostics diagnostics;
  diagnostics.update(refused);
  DiagnosticStatusWrapper status;
  diagnostics.fill(status);
  EXPECT_EQ(status.level, DiagnosticStatus::ERROR);
  EXPECT_EQ(status.message, "idle, configuration refused: events_port: found 'x'");
}

}  // namespace
}  // namespace fast_edi
