#include "rostest/stub_camera.hpp"

#include <chrono>

namespace fast_edi {
namespace test {
namespace {

constexpr std::uint32_t kQueue = 1000;

}  // namespace

StubCamera::StubCamera(const std::string& ns, RecordingSettings settings, int haste)
    : nh_(ns),
      events_(nh_.advertise<EventArray>("events", kQueue)),
      image_(nh_.advertise<sensor_msgs::Image>("image_raw", kQueue)),
      exposure_(nh_.advertise<std_msgs::Int32>("exposure", kQueue)),
      camera_info_(nh_.advertise<sensor_msgs::CameraInfo>("camera_info", kQueue)),
      thread_([this, settings, haste] { run(settings, haste); }) {}

StubCamera::~StubCamera() {
  stop_ = true;
  thread_.join();
}

void StubCamera::run(RecordingSettings settings, int haste) {
  const std::int64_t first_ns = settings.start_ns;
  const auto start = std::chrono::steady_clock::now();
  while (!stop_) {
    for (const Arrival& arrival : makeRecording(settings)) {
      if (stop_) {
        return;
      }
      std::this_thread::sleep_until(start +
                                    std::chrono::nanoseconds((arrival.time_ns - first_ns) / haste));
      publish(arrival);
      settings.start_ns = arrival.time_ns;
      settings.first_sequence += arrival.events ? 1 : 0;
    }
    ++settings.seed;
  }
}

void StubCamera::publish(const Arrival& arrival) {
  if (arrival.events) {
    events_.publish(arrival.events);
  } else if (arrival.image) {
    image_.publish(arrival.image);
  } else if (arrival.info) {
    camera_info_.publish(arrival.info);
  } else {
    exposure_.publish(arrival.exposure);
  }
}

}  // namespace test
}  // namespace fast_edi
