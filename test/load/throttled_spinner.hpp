/// \file
/// A thread that calls callbacks and rests in between, so that what they do gets a share of a
/// processor.
#pragma once

#include <time.h>

#include <atomic>
#include <chrono>
#include <thread>

#include <ros/callback_queue.h>

namespace fast_edi::load {

class ThrottledSpinner {
 public:
  /// \param share of a processor that callbacks get, (0, 1]
  ThrottledSpinner(ros::CallbackQueue& queue, double share)
      : thread_([this, &queue, rest = 1.0 / share - 1.0] { run(queue, rest); }) {}
  ~ThrottledSpinner() {
    stop_ = true;
    thread_.join();
  }
  ThrottledSpinner(const ThrottledSpinner&) = delete;
  ThrottledSpinner& operator=(const ThrottledSpinner&) = delete;

 private:
  /// CPU time of this thread: other work on the machine is no work of the callbacks.
  static std::chrono::duration<double> worked() {
    timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return std::chrono::seconds(time.tv_sec) + std::chrono::nanoseconds(time.tv_nsec);
  }

  void run(ros::CallbackQueue& queue, double rest) {
    // Shorter rests cost more than they are long.
    constexpr std::chrono::duration<double> kShortestRest = std::chrono::microseconds(500);
    std::chrono::duration<double> owed{0};
    while (!stop_) {
      const auto before = worked();
      queue.callOne(ros::WallDuration(0.001));
      owed += (worked() - before) * rest;
      if (owed > kShortestRest) {
        const auto begin = std::chrono::steady_clock::now();
        std::this_thread::sleep_for(owed);
        owed -= std::chrono::steady_clock::now() - begin;
      }
    }
  }

  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace fast_edi::load
