/// \file
/// Threads that share out the steps of some work: whichever is free takes the next step that can be
/// taken. So all of them have something to do as long as there is anything, and one whose core is
/// busy elsewhere holds up its own step alone.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <utility>

namespace fast_edi {

class WorkerCrew {
 public:
  struct Step {
    std::function<void()> work;  ///< at the same time as other steps
    std::function<void()> done;  ///< behind it, while nothing else is chosen or done
  };
  /// Called while nothing else is chosen or done.
  /// \return a step that can be taken now; nothing while there is none
  using Choose = std::function<std::optional<Step>()>;

  explicit WorkerCrew(Choose choose) : choose_(std::move(choose)) {}

  /// Works until no step can be taken and none is under way.
  /// \param threads that work, the calling one among them; at least 1
  /// \throws what a step or its choice has thrown, the first one: those under way are ended then,
  ///         and no others taken; std::system_error when there can be no more threads
  void run(std::size_t threads);

 private:
  void work();
  std::optional<Step> take();
  void finish(const Step& step);
  void fail();

  const Choose choose_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::size_t under_way_ = 0;  ///< steps
  std::exception_ptr failure_;
};

}  // namespace fast_edi
