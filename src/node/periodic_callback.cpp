#include "node/periodic_callback.hpp"

#include <utility>

namespace fast_edi {

PeriodicCallback::PeriodicCallback(const ros::NodeHandle& nh, ros::WallDuration period,
                                   std::function<void()> work)
    : state_(std::make_shared<State>()) {
  state_->work = std::move(work);
  timer_ = nh.createSteadyTimer(period, [state = state_](const ros::SteadyTimerEvent&) {
    const std::lock_guard<std::mutex> lock(state->at_work);
    if (!state->ended) {
      state->work();
    }
  });
}

PeriodicCallback::~PeriodicCallback() {
  timer_.stop();
  const std::lock_guard<std::mutex> lock(state_->at_work);
  state_->ended = true;
}

}  // namespace fast_edi
