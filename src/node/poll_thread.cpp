#include "node/poll_thread.hpp"

#include <chrono>
#include <future>
#include <memory>

#include <ros/init.h>
#include <ros/poll_manager.h>

namespace fast_edi {
namespace {

/// Time between looks whether ROS has been shut down, and with it the thread. One round takes 0.1 s
/// at most where nothing comes.
constexpr std::chrono::milliseconds kLook(50);

/// Tells when its first call has begun.
class FirstCall {
 public:
  void operator()() {
    if (!called_) {
      called_ = true;
      begun_.set_value();
    }
  }
  std::future<void> begun() { return begun_.get_future(); }

 private:
  bool called_ = false;
  std::promise<void> begun_;
};

}  // namespace

void waitForPollThread() {
  const auto call = std::make_shared<FirstCall>();
  const std::future<void> begun = call->begun();
  ros::PollManager& manager = *ros::PollManager::instance();
  // Listeners are called between rounds, so that the round of now is over by then.
  const auto listener = manager.addPollThreadListener([call] { (*call)(); });
  manager.getPollSet().signal();
  while (ros::isStarted() && begun.wait_for(kLook) != std::future_status::ready) {
  }
  manager.removePollThreadListener(listener);
}

}  // namespace fast_edi
