#include "stages/worker_crew.hpp"

#include <gmock/gmock.h>

#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <optional>
#include <set>
#include <stdexcept>
#include <thread>
#include <vector>

namespace fast_edi {
namespace {

using ::testing::ElementsAreArray;

constexpr std::size_t kSteps = 200;

/// Waits until so many threads have come, whatever the system's scheduler does.
class Meeting {
 public:
  explicit Meeting(std::size_t threads) : missing_(threads) {}
  void come() {
    std::unique_lock<std::mutex> lock(mutex_);
    --missing_;
    changed_.notify_all();
    changed_.wait(lock, [this] { return missing_ == 0; });
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::size_t missing_;
};

class WorkerCrewTest : public ::testing::TestWithParam<std::size_t> {};
INSTANTIATE_TEST_SUITE_P(Threads, WorkerCrewTest, ::testing::Values(1, 2, 3, 8));

TEST_P(WorkerCrewTest, TakesEveryStepOnce) {
  std::size_t next = 0;
  std::size_t done = 0;
  std::vector<int> works(kSteps, 0);
  WorkerCrew crew([&]() -> std::optional<WorkerCrew::Step> {
    if (next == kSteps) {
      return std::nullopt;
    }
    const std::size_t step = next++;
    return WorkerCrew::Step{[&works, step] { ++works[step]; }, [&done] { ++done; }};
  });
  crew.run(GetParam());
  EXPECT_THAT(works, ElementsAreArray(std::vector<int>(kSteps, 1)));
  EXPECT_EQ(done, kSteps);
}

TEST_P(WorkerCrewTest, WaitsForStepsThatOthersMakePossible) {
  // Each step makes the next one possible: no thread may leave while one is under way.
  std::size_t done = 0;
  bool under_way = false;
  std::vector<std::size_t> order;
  WorkerCrew crew([&]() -> std::optional<WorkerCrew::Step> {
    if (under_way || done == kSteps) {
      return std::nullopt;
    }
    under_way = true;
    return WorkerCrew::Step{[&] { order.push_back(done); },
                            [&] {
                              under_way = false;
                              ++done;
                            }};
  });
  crew.run(GetParam());
  ASSERT_EQ(order.size(), kSteps);
  for (std::size_t i = 0; i < kSteps; ++i) {
    EXPECT_EQ(order[i], i);
  }
}

TEST_P(WorkerCrewTest, WorksOnAsManyThreadsAsItWasToldTo) {
  Meeting meeting(GetParam());
  std::size_t next = 0;
  std::mutex mutex;
  std::set<std::thread::id> threads;
  WorkerCrew crew([&]() -> std::optional<WorkerCrew::Step> {
    if (next == GetParam()) {
      return std::nullopt;
    }
    ++next;
    return WorkerCrew::Step{[&] {
                              {
                                const std::lock_guard<std::mutex> lock(mutex);
                                threads.insert(std::this_thread::get_id());
                              }
                              meeting.come();  // only when all are at work
                            },
                            [] {}};
  });
  crew.run(GetParam());
  EXPECT_EQ(threads.size(), GetParam());
  EXPECT_EQ(threads.count(std::this_thread::get_id()), 1u);
}

TEST_P(WorkerCrewTest, ThrowsWhatAStepThrowsAndTakesNoMore) {
  constexpr std::size_t kBad = 20;
  std::size_t next = 0;
  WorkerCrew crew([&]() -> std::optional<WorkerCrew::Step> {
    const std::size_t step = next++;  // there is always one more: only the failure ends this
    return WorkerCrew::Step{[step] {
                              if (step == kBad) {
                                throw std::runtime_error("the disk is full");
                              }
                            },
                            [] {}};
  });
  try {
    crew.run(GetParam());
    FAIL() << "nothing was thrown";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "the disk is full");
  }
}

TEST_P(WorkerCrewTest, ThrowsWhatChoosingThrows) {
  WorkerCrew crew([]() -> std::optional<WorkerCrew::Step> { throw std::out_of_range("choice"); });
  EXPECT_THROW(crew.run(GetParam()), std::out_of_range);
}

TEST_P(WorkerCrewTest, NothingToDoEndsAtOnce) {
  WorkerCrew crew([] { return std::optional<WorkerCrew::Step>(); });
  crew.run(GetParam());
}

}  // namespace
}  // namespace fast_edi
