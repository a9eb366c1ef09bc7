#include "node/callback_thread.hpp"

#include <utility>

#include <boost/make_shared.hpp>

#include "node/poll_thread.hpp"

namespace fast_edi {
namespace {

/// How long stop() may have to wait for an idle thread.
const ros::WallDuration kLongestWait(0.05);

class Work : public ros::CallbackInterface {
 public:
  explicit Work(std::function<void()> work) : work_(std::move(work)) {}
  CallResult call() override {
    work_();
    return Success;
  }

 private:
  std::function<void()> work_;
};

}  // namespace

CallbackThread::~CallbackThread() {
  stop();
  waitForPollThread();
}

ros::NodeHandle CallbackThread::handle(const ros::NodeHandle& nh) {
  ros::NodeHandle own(nh);
  own.setCallbackQueue(&queue_);
  return own;
}

void CallbackThread::post(std::function<void()> work) {
  queue_.addCallback(boost::make_shared<Work>(std::move(work)));
}

void CallbackThread::repeat(const ros::NodeHandle& nh, ros::WallDuration period,
                            std::function<void()> work) {
  timer_ = handle(nh).createSteadyTimer(
      period, [work = std::move(work)](const ros::SteadyTimerEvent&) { work(); });
}

void CallbackThread::start() {
  thread_ = std::thread([this] {
    while (!stopped_) {
      queue_.callOne(kLongestWait);
    }
  });
}

void CallbackThread::stop() {
  stopped_ = true;
  if (thread_.joinable()) {
    thread_.join();
  }
  timer_.stop();
  queue_.disable();
  queue_.clear();
}

}  // namespace fast_edi
