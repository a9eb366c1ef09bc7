#include "stages/worker_crew.hpp"

#include <thread>
#include <utility>
#include <vector>

namespace fast_edi {

void WorkerCrew::run(std::size_t threads) {
  std::vector<std::thread> others;
  try {
    while (others.size() + 1 < threads) {
      others.emplace_back([this] { work(); });
    }
    work();
  } catch (...) {
    fail();
  }
  for (std::thread& thread : others) {
    thread.join();
  }
  if (failure_) {
    std::rethrow_exception(failure_);
  }
}

void WorkerCrew::work() {
  try {
    while (const std::optional<Step> step = take()) {
      step->work();
      finish(*step);
    }
  } catch (...) {
    fail();
  }
}

/// Waits for a step. \return nothing at the end
std::optional<WorkerCrew::Step> WorkerCrew::take() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (!failure_) {
    if (std::optional<Step> step = choose_()) {
      ++under_way_;
      return step;
    }
    if (under_way_ == 0) {
      break;
    }
    changed_.wait(lock);
  }
  changed_.notify_all();
  return std::nullopt;
}

void WorkerCrew::finish(const Step& step) {
  const std::lock_guard<std::mutex> lock(mutex_);
  step.done();
  --under_way_;
  changed_.notify_all();
}

void WorkerCrew::fail() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!failure_) {
    failure_ = std::current_exception();
  }
  changed_.notify_all();
}

}  // namespace fast_edi
