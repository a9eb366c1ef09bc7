/// \file
/// Event arrays between roscpp's thread and the node's callbacks, bounded by the events they hold.
///
/// roscpp bounds the queue of a subscription by the number of messages. With 1000 arrays of 10 ms
/// at 13 million events a second that is 1.7 GB, and it fills up whenever callbacks take longer
/// than events keep coming. Here the oldest arrays go as soon as a number of events is reached.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <shared_mutex>

#include <ros/callback_queue_interface.h>

namespace fast_edi {

class WaitingArrays {
 public:
  struct Limits {
    std::size_t arrays = 0;
    std::size_t events = 0;
  };
  using Delivery = std::function<void()>;
  /// \param events of the arrays that were dropped between the last delivery and the next
  using LossHandler = std::function<void(std::size_t events)>;

  /// \param queue whose thread delivers; must outlive this object
  /// \param on_loss called from \p queue as well
  WaitingArrays(ros::CallbackQueueInterface& queue, Limits limits, LossHandler on_loss);
  /// See end().
  ~WaitingArrays();
  WaitingArrays(const WaitingArrays&) = delete;
  WaitingArrays& operator=(const WaitingArrays&) = delete;

  /// Lets \p deliver be called from the queue, in the order of arrival. Drops the oldest arrays
  /// beyond the limits, but never the last one. From any thread; never waits for a delivery.
  void add(std::size_t events, Delivery deliver);
  /// Another limit on events, from the next array on.
  void limitEvents(std::size_t events);
  /// Drops what waits and what is added later, and waits for deliveries at work: not to be called
  /// from one, nor with a lock held that one may want.
  void end();

 private:
  struct Waiting {
    std::size_t events = 0;
    Delivery deliver;
  };
  /// Shared with the callbacks in the queue: roscpp may call one that it had already taken out
  /// when the others were removed.
  struct State {
    LossHandler on_loss;
    std::shared_mutex at_work;  ///< held by each delivery; taken before mutex
    std::mutex mutex;           ///< guards what is below; held for a moment only
    Limits limits;
    bool ended = false;  ///< nothing is delivered any more
    std::deque<Waiting> waiting;
    std::size_t waiting_events = 0;
    std::size_t lost_events = 0;  ///< in front of waiting
    std::size_t callbacks = 0;    ///< in the callback queue; never fewer than waiting
  };
  class DeliveryCallback;

  std::uint64_t id() const { return reinterpret_cast<std::uintptr_t>(this); }

  ros::CallbackQueueInterface& queue_;
  const std::shared_ptr<State> state_;
};

}  // namespace fast_edi
