/// \file
/// A timer whose end waits for its callback.
#pragma once

#include <functional>
#include <memory>
#include <mutex>

#include <ros/node_handle.h>
#include <ros/steady_timer.h>

namespace fast_edi {

/// roscpp's own timers do not wait, since version 1.15.10: CallbackQueue::removeByID() leaves a
/// callback alone that is at work in another thread.
class PeriodicCallback {
 public:
  /// \param nh whose callback queue calls \p work once in each \p period, one call at a time
  PeriodicCallback(const ros::NodeHandle& nh, ros::WallDuration period, std::function<void()> work);
  /// No call comes any more. Waits for one at work: not to be used in one, nor with a lock held
  /// that one may want.
  ~PeriodicCallback();
  PeriodicCallback(const PeriodicCallback&) = delete;
  PeriodicCallback& operator=(const PeriodicCallback&) = delete;

 private:
  /// Shared with callbacks in the queue, one of which may just begin when the timer ends.
  struct State {
    std::mutex at_work;  ///< held by each call
    std::function<void()> work;
    bool ended = false;
  };

  const std::shared_ptr<State> state_;
  ros::SteadyTimer timer_;
};

}  // namespace fast_edi
