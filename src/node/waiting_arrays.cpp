#include "node/waiting_arrays.hpp"

#include <mutex>
#include <shared_mutex>
#include <utility>

#include <boost/make_shared.hpp>

namespace fast_edi {

/// One delivery in the callback queue.
class WaitingArrays::DeliveryCallback : public ros::CallbackInterface {
 public:
  explicit DeliveryCallback(std::shared_ptr<State> state) : state_(std::move(state)) {}
  CallResult call() override {
    const std::shared_lock<std::shared_mutex> at_work(state_->at_work);
    Waiting next;
    std::size_t lost_events = 0;
    {
      const std::lock_guard<std::mutex> lock(state_->mutex);
      --state_->callbacks;
      if (state_->ended || state_->waiting.empty()) {
        return Success;
      }
      next = std::move(state_->waiting.front());
      state_->waiting.pop_front();
      state_->waiting_events -= next.events;
      lost_events = std::exchange(state_->lost_events, 0);
    }
    if (lost_events > 0) {
      state_->on_loss(lost_events);
    }
    next.deliver();
    return Success;
  }

 private:
  std::shared_ptr<State> state_;
};

WaitingArrays::WaitingArrays(ros::CallbackQueueInterface& queue, Limits limits, LossHandler on_loss)
    : queue_(queue), state_(std::make_shared<State>()) {
  state_->limits = limits;
  state_->on_loss = std::move(on_loss);
}

WaitingArrays::~WaitingArrays() {
  end();
}

void WaitingArrays::end() {
  std::deque<Waiting> dropped;  // freed without the mutex
  {
    const std::lock_guard<std::mutex> lock(state_->mutex);
    if (std::exchange(state_->ended, true)) {
      return;
    }
    dropped.swap(state_->waiting);
  }
  queue_.removeByID(id());
  const std::unique_lock<std::shared_mutex> waits_for_those_at_work(state_->at_work);
}

void WaitingArrays::add(std::size_t events, Delivery deliver) {
  std::deque<Waiting> dropped;  // freed without the mutex
  bool needs_callback = false;
  {
    State& state = *state_;
    const std::lock_guard<std::mutex> lock(state.mutex);
    if (state.ended) {
      return;
    }
    state.waiting.push_back({events, std::move(deliver)});
    state.waiting_events += events;
    while (state.waiting.size() > 1 && (state.waiting.size() > state.limits.arrays ||
                                        state.waiting_events > state.limits.events)) {
      state.waiting_events -= state.waiting.front().events;
      state.lost_events += state.waiting.front().events;
      dropped.push_back(std::move(state.waiting.front()));
      state.waiting.pop_front();
    }
    needs_callback = state.callbacks < state.waiting.size();
    state.callbacks += needs_callback ? 1 : 0;
  }
  if (needs_callback) {
    queue_.addCallback(boost::make_shared<DeliveryCallback>(state_), id());
  }
}

void WaitingArrays::limitEvents(std::size_t events) {
  const std::lock_guard<std::mutex> lock(state_->mutex);
  state_->limits.events = events;
}

}  // namespace fast_edi
