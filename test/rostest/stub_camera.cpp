#include "rostest/stub_camera.hpp"

#include <chrono>

namespace fast_edi {
namespace test {

StubCamera::StubCamera(const std::string& ns, RecordingSettings settings, int haste)
    : nh_(ns), publishers_(nh_), thread_([this, settings, haste] { run(settings, haste); }) {}

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
      publishers_.publish(arrival);
      settings.start_ns = arrival.time_ns;
      settings.first_sequence += arrival.events ? 1 : 0;
    }
    ++settings.seed;
  }
}

}  // namespace test
}  // namespace fast_edi
