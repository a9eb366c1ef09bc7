#include "stream/interrupt.hpp"

#include <poll.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <thread>

#include <gtest/gtest.h>

namespace fast_edi {
namespace {

using std::chrono::milliseconds;

TEST(Interrupt, EndsAWaitInAnotherThread) {
  Interrupt interrupt;
  std::thread other([&] { interrupt.raise(); });
  EXPECT_TRUE(interrupt.waitFor(std::chrono::minutes(1)));
  other.join();
  EXPECT_TRUE(interrupt.waitFor(milliseconds(0))) << "it was raised for good";
  EXPECT_EQ(interrupt.waitFor(-1, 0, milliseconds(0)), Interrupt::Wait::kInterrupted);
}

TEST(Interrupt, WaitsForADescriptorToo) {
  std::array<int, 2> ends = {};
  ASSERT_EQ(::pipe(ends.data()), 0);
  const Interrupt interrupt;
  EXPECT_FALSE(interrupt.waitFor(milliseconds(1)));
  EXPECT_EQ(interrupt.waitFor(ends[0], POLLIN, milliseconds(1)), Interrupt::Wait::kTimeout);
  ASSERT_EQ(::write(ends[1], "x", 1), 1);
  EXPECT_EQ(interrupt.waitFor(ends[0], POLLIN, std::chrono::minutes(1)), Interrupt::Wait::kReady);
  ::close(ends[0]);
  ::close(ends[1]);
}

}  // namespace
}  // namespace fast_edi
