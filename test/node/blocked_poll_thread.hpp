/// \file
/// roscpp's thread for connections, halted.
#pragma once

#include <functional>
#include <future>
#include <memory>
#include <utility>

#include <ros/poll_manager.h>

namespace fast_edi {
namespace test {

/// From construction until finish() that thread is at work, as if it just handled a request.
/// \pre requireRos()
class BlockedPollThread {
 public:
  BlockedPollThread() : work_(std::make_shared<Work>()) {
    listener_ = ros::PollManager::instance()->addPollThreadListener([work = work_] {
      if (!work->begun) {
        work->begun = true;
        work->has_begun.set_value();
        work->end.get_future().get()();
      }
    });
    work_->has_begun.get_future().wait();
  }
  ~BlockedPollThread() { ros::PollManager::instance()->removePollThreadListener(listener_); }
  BlockedPollThread(const BlockedPollThread&) = delete;
  BlockedPollThread& operator=(const BlockedPollThread&) = delete;

  /// Lets it call \p last and go on. Once, and before destruction.
  void finish(std::function<void()> last) { work_->end.set_value(std::move(last)); }

 private:
  struct Work {
    bool begun = false;  ///< of the thread alone
    std::promise<void> has_begun;
    std::promise<std::function<void()>> end;
  };

  std::shared_ptr<Work> work_;
  boost::signals2::connection listener_;
};

}  // namespace test
}  // namespace fast_edi
