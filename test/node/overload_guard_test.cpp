#include "node/overload_guard.hpp"

#include <gtest/gtest.h>

namespace fast_edi {
namespace {

using Action = OverloadGuard::Action;

constexpr std::int64_t kTick_ns = 4'000'000;
constexpr std::int64_t kSecond_ns = 1'000'000'000;

class OverloadGuardTest : public ::testing::Test {
 protected:
  /// Some time of events that arrive, a share of which is lost; how often \p wanted was taken.
  int pass(std::int64_t length_ns, std::uint64_t events_a_tick, double share_lost, Action wanted) {
    int taken = 0;
    for (const std::int64_t end_ns = now_ns_ + length_ns; now_ns_ < end_ns; now_ns_ += kTick_ns) {
      counts_.events += events_a_tick;
      counts_.events_lost +=
          static_cast<std::uint64_t>(share_lost * static_cast<double>(events_a_tick));
      counts_.frames += frames_a_tick_;
      const Action action = guard_.update(now_ns_, counts_);
      taken += action == wanted ? 1 : 0;
      last_ = action == Action::kNone ? last_ : action;
    }
    return taken;
  }

  OverloadGuard guard_;
  Action last_ = Action::kNone;
  std::int64_t now_ns_ = 7 * kSecond_ns;
  OverloadGuard::Counts counts_{1'000'000, 900'000, 30};  // of the time before
  std::uint64_t frames_a_tick_ = 1;
};

TEST_F(OverloadGuardTest, GoesOnWhileAtLeastHalfIsTakenIn) {
  EXPECT_EQ(pass(10 * kSecond_ns, 1000, 0.0, Action::kSuspend), 0);
  EXPECT_EQ(pass(10 * kSecond_ns, 1000, 0.5, Action::kSuspend), 0);
  EXPECT_EQ(pass(10 * kSecond_ns, 0, 0.0, Action::kSuspend), 0);
  EXPECT_EQ(last_, Action::kNone);
}

TEST_F(OverloadGuardTest, WithoutFramesEventsAreLostForNobody) {
  frames_a_tick_ = 0;
  EXPECT_EQ(pass(10 * kSecond_ns, 1000, 1.0, Action::kSuspend), 0);
  frames_a_tick_ = 1;
  EXPECT_EQ(pass(2 * kSecond_ns, 1000, 1.0, Action::kSuspend), 1);
}

TEST_F(OverloadGuardTest, FramesThatAreLateThemselvesAreWaitedFor) {
  pass(kSecond_ns, 1000, 0.0, Action::kSuspend);
  frames_a_tick_ = 0;
  EXPECT_EQ(pass(kSecond_ns, 1000, 1.0, Action::kSuspend), 1);
}

TEST_F(OverloadGuardTest, BearsABurst) {
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(pass(OverloadGuard::kWindow_ns, 1000, 1.0, Action::kSuspend), 0);
    EXPECT_EQ(pass(2 * OverloadGuard::kWindow_ns, 1000, 0.0, Action::kSuspend), 0);
  }
}

TEST_F(OverloadGuardTest, SuspendsAndResumesInTurn) {
  EXPECT_EQ(pass(2 * kSecond_ns, 1000, 0.9, Action::kSuspend), 1);
  EXPECT_EQ(pass(OverloadGuard::kPause_ns, 0, 0.0, Action::kResume), 1);
  EXPECT_EQ(last_, Action::kResume);
  EXPECT_EQ(pass(5 * kSecond_ns, 1000, 0.1, Action::kSuspend), 0) << "the load is gone";
  EXPECT_EQ(pass(2 * kSecond_ns, 1000, 0.9, Action::kSuspend), 1) << "it came again";
}

TEST_F(OverloadGuardTest, MostOfTheTimeIsLeftToFramesWhileEventsStayTooMany) {
  const int suspended = pass(30 * kSecond_ns, 1000, 0.9, Action::kSuspend);
  EXPECT_GE(suspended, 10);
  EXPECT_LE(suspended, 13);
}

}  // namespace
}  // namespace fast_edi
