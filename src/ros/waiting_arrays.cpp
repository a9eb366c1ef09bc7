#include "fast_edi/ros/waiting_arrays.hpp"

#include <utility>

#include <boost/make_shared.hpp>

namespace fast_edi {

/// One delivery in the callback queue.
class WaitingArrays::Turn : public ros::CallbackInterface {
 public:
  explicit Turn(WaitingArrays& arrays) : arrays_(arrays) {}
  CallResult call() override {
    arrays_.deliverNext();
    return Success;
  }

 private:
  WaitingArrays& arrays_;
};

WaitingArrays::WaitingArrays(ros::CallbackQueueInterface& queue, Limits limits, LossHandler on_loss)
    : queue_(queue), on_loss_(std::move(on_loss)), limits_(limits) {}

WaitingArrays::~WaitingArrays() {
  queue_.removeByID(id());
}

void WaitingArrays::add(std::size_t events, Delivery deliver) {
  std::deque<Waiting> dropped;  // freed without the mutex
  bool needs_turn = false;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    waiting_.push_back({events, std::move(deliver)});
    waiting_events_ += events;
    while (waiting_.size() > 1 &&
           (waiting_.size() > limits_.arrays || waiting_events_ > limits_.events)) {
      waiting_events_ -= waiting_.front().events;
      lost_events_ += waiting_.front().events;
      dropped.push_back(std::move(waiting_.front()));
      waiting_.pop_front();
    }
    needs_turn = turns_ < waiting_.size();
    turns_ += needs_turn ? 1 : 0;
  }
  if (needs_turn) {
    queue_.addCallback(boost::make_shared<Turn>(*this), id());
  }
}

void WaitingArrays::limitEvents(std::size_t events) {
  const std::lock_guard<std::mutex> lock(mutex_);
  limits_.events = events;
}

void WaitingArrays::deliverNext() {
  Waiting next;
  std::size_t lost_events = 0;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    --turns_;
    if (waiting_.empty()) {
      return;
    }
    next = std::move(waiting_.front());
    waiting_.pop_front();
    waiting_events_ -= next.events;
    lost_events = std::exchange(lost_events_, 0);
  }
  if (lost_events > 0) {
    on_loss_(lost_events);
  }
  next.deliver();
}

}  // namespace fast_edi
