#include "tag_node/tag_diagnostics.hpp"

#include <string>

#include <gmock/gmock.h>

#include "fast_edi/base/types.hpp"
#include "node/diagnostic_value.hpp"
#include "support/comma_locale.hpp"

namespace fast_edi {
namespace {

using diagnostic_msgs::DiagnosticStatus;
using diagnostic_updater::DiagnosticStatusWrapper;
using ::testing::HasSubstr;
using testing::value;

class TagDiagnosticsTest : public ::testing::Test {
 protected:
  TagDiagnosticsTest() {
    now_.time_ns = 100 * kNanosecondsPerSecond;
    now_.listening = true;
    now_.listening_since_ns = 99 * kNanosecondsPerSecond;
    now_.last_frame_ns = now_.time_ns;
    diagnostics_.update(now_);
  }

  /// Half a second later, with a frame just come.
  DiagnosticStatusWrapper report() {
    now_.time_ns += kNanosecondsPerSecond / 2;
    now_.last_frame_ns = now_.time_ns;
    return reportAsItIs();
  }

  DiagnosticStatusWrapper reportAsItIs() {
    diagnostics_.update(now_);
    DiagnosticStatusWrapper status;
    diagnostics_.fill(detection_time_, status);
    return status;
  }

  TagDiagnostics diagnostics_{"/dvs/deblurred/image_raw"};
  TagSnapshot now_;
  LatencyRecord detection_time_;
};

TEST_F(TagDiagnosticsTest, CountsAndRates) {
  now_.frames = 20;
  now_.frames_with_tags = 15;
  now_.tags = 31;
  now_.tags_in_last_frame = 2;
  now_.frame_id = "camera";
  for (int ms = 1; ms <= 100; ++ms) {
    detection_time_.add(ms * kNanosecondsPerMillisecond);
  }
  const DiagnosticStatusWrapper status = report();
  EXPECT_EQ(status.level, DiagnosticStatus::OK);
  EXPECT_EQ(value(status, "Frame rate [Hz]"), "40.00");
  EXPECT_EQ(value(status, "Tags in the last frame"), "2");
  EXPECT_EQ(value(status, "Frames"), "20");
  EXPECT_EQ(value(status, "Frames with tags"), "15");
  EXPECT_EQ(value(status, "Frames with tags [%]"), "75.0");
  EXPECT_EQ(value(status, "Tags"), "31");
  EXPECT_EQ(value(status, "Detection p50 [ms]"), "50.000");
  EXPECT_EQ(value(status, "Detection p99 [ms]"), "99.000");
  EXPECT_EQ(value(status, "Poses"), "yes");
  EXPECT_EQ(value(status, "Frame id"), "camera");
}

TEST_F(TagDiagnosticsTest, WritesNumbersTheSameUnderEveryLocale) {
  now_.frames = 1'234'567;
  now_.time_ns += 5 * kNanosecondsPerSecond / 2;
  const testing::CommaLocale comma;
  const DiagnosticStatusWrapper status = reportAsItIs();
  EXPECT_EQ(value(status, "Frames"), "1234567");
  EXPECT_EQ(value(status, "Frames with tags [%]"), "0.0");
  EXPECT_THAT(status.message, HasSubstr("2.5 s"));
}

TEST_F(TagDiagnosticsTest, SilenceIsAnError) {
  now_.time_ns += 3 * kNanosecondsPerSecond;
  const DiagnosticStatusWrapper status = reportAsItIs();
  EXPECT_EQ(status.level, DiagnosticStatus::ERROR);
  EXPECT_THAT(status.message, HasSubstr("no image on /dvs/deblurred/image_raw for 3.0 s"));
}

TEST_F(TagDiagnosticsTest, IdleIsNotSilent) {
  now_.listening = false;
  now_.time_ns += 3 * kNanosecondsPerSecond;
  const DiagnosticStatusWrapper status = reportAsItIs();
  EXPECT_EQ(status.level, DiagnosticStatus::OK);
  EXPECT_THAT(status.message, HasSubstr("idle"));
}

TEST_F(TagDiagnosticsTest, WarnsOncePerFault) {
  now_.frames_refused = 2;
  now_.refusal = "encoding \"32FC1\"";
  now_.frame_gaps = 1;
  now_.frames_repeated = 3;
  now_.internal_errors = 1;
  now_.internal_error = "something";
  DiagnosticStatusWrapper status = report();
  EXPECT_EQ(status.level, DiagnosticStatus::WARN);
  EXPECT_THAT(status.message, HasSubstr("2 image(s) on /dvs/deblurred/image_raw refused: enc"));
  EXPECT_THAT(status.message, HasSubstr("1 hole(s) in header.seq"));
  EXPECT_THAT(status.message, HasSubstr("1 internal error(s): something"));
  EXPECT_THAT(status.message, HasSubstr("3 image(s) on /dvs/deblurred/image_raw came twice"));
  EXPECT_EQ(diagnostics_.complaints().size(), 4U);
  status = report();
  EXPECT_EQ(status.level, DiagnosticStatus::OK);
  EXPECT_EQ(value(status, "Frames refused"), "2");
}

TEST_F(TagDiagnosticsTest, SaysWhatKeepsPosesAway) {
  now_.no_pose_reason = "K of camera_info is zero";
  const DiagnosticStatusWrapper status = report();
  EXPECT_EQ(value(status, "Poses"), "no: K of camera_info is zero");
  EXPECT_THAT(value(status, "Frame id"), HasSubstr("set the parameter frame_id"));
}

TEST_F(TagDiagnosticsTest, ARefusedConfigurationIsAnError) {
  now_.configuration_error = "family: found '36h12'";
  const DiagnosticStatusWrapper status = reportAsItIs();
  EXPECT_EQ(status.level, DiagnosticStatus::ERROR);
  EXPECT_THAT(status.message, HasSubstr("configuration refused: family: found '36h12'"));
}

}  // namespace
}  // namespace fast_edi
