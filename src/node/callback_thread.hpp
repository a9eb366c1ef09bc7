/// \file
/// A callback queue with its own thread, for callbacks that must not share the thread of the
/// inputs.
#pragma once

#include <atomic>
#include <functional>
#include <thread>

#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/steady_timer.h>

namespace fast_edi {

/// One thread that calls the callbacks of one queue, in order. Here: requests to change parameters,
/// subscribers of the outputs that come and go, and what calls the ROS master.
///
/// Why the latter need it: a publisher's end does not wait for its callback that is at work, and
/// image_transport's then works on freed memory. The same holds for services. With this class:
/// stop() first, end publishers and services then; what is still queued is never called.
class CallbackThread {
 public:
  CallbackThread() = default;
  /// Waits for a callback at work, and for roscpp, which may be about to queue one: the caller must
  /// hold no lock that these may want.
  ~CallbackThread();
  CallbackThread(const CallbackThread&) = delete;
  CallbackThread& operator=(const CallbackThread&) = delete;

  /// The same node and namespace, with callbacks in this thread.
  ros::NodeHandle handle(const ros::NodeHandle& nh);

  /// Where handle() puts callbacks.
  ros::CallbackQueueInterface& queue() { return queue_; }

  /// Lets \p work be called in this thread, behind what is queued. From any thread; waits for none.
  void post(std::function<void()> work);

  /// Lets \p work be called in this thread once in each \p period, until stop(). Once.
  /// \param nh any handle
  void repeat(const ros::NodeHandle& nh, ros::WallDuration period, std::function<void()> work);

  /// From now on callbacks are called, those that are queued already too. Once; nothing after
  /// stop().
  void start();

  /// No callback is called any more, whatever is still queued or comes; final. Waits for one at
  /// work: the caller must hold no lock that this may want.
  void stop();

 private:
  ros::CallbackQueue queue_;
  std::atomic<bool> stopped_{false};
  std::thread thread_;
  ros::SteadyTimer timer_;
};

}  // namespace fast_edi
