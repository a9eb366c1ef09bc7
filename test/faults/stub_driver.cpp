// A driver to be killed: a made-up camera in a process of its own, stamping with the host's clock
// as a driver does. Topics are relative.

#include <ros/init.h>
#include <ros/time.h>

#include "rostest/stub_camera.hpp"

int main(int argc, char** argv) {
  ros::init(argc, argv, "stub_driver");
  const ros::NodeHandle keeps_ros_running;
  fast_edi::test::RecordingSettings settings;
  settings.start_ns = static_cast<std::int64_t>(ros::WallTime::now().toNSec());
  settings.size = {346, 260};
  settings.array_period_ns = 10 * fast_edi::kNanosecondsPerMillisecond;
  // Begins with a frame rather than with events, as a driver may.
  settings.first_exposure_ns = 0;
  const fast_edi::test::StubCamera camera("", settings, 1);
  ros::spin();
  return 0;
}
