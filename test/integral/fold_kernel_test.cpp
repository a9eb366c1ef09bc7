#include "integral/fold_kernel.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fast_edi {
namespace {

constexpr std::size_t kPixels = 7;
constexpr std::uint16_t kMostTicks = 400;

EventFactors factors() {
  EventFactors factors{};
  const double steps[2] = {-0.24, 0.31};
  for (std::size_t on = 0; on < 2; ++on) {
    factors.multiplier[on] = std::exp(steps[on]);
    factors.one_minus[on] = 1.0 - factors.multiplier[on];
    factors.excess[on] = (std::exp(0.4 * steps[on]) - 1.0) * 1000.0;
  }
  factors.most_ticks = kMostTicks;
  return factors;
}

std::vector<PixelSums> noEvents() {
  return std::vector<PixelSums>(kPixels, PixelSums{0.0, 1.0});
}

struct Stream {
  std::vector<PackedEvent> events;
  std::vector<std::uint16_t> intervals;
};

/// Few pixels, so that neighbours in the log often share one.
Stream anyStream(std::size_t count, std::uint32_t seed) {
  std::mt19937 random(seed);
  Stream stream;
  std::uint32_t dt_ns = 0;
  for (std::size_t i = 0; i < count; ++i) {
    dt_ns += random() % 50'000;
    stream.events.push_back({dt_ns, static_cast<std::uint32_t>(random() % (2 * kPixels))});
    // Around the longest ramp, and at the far end.
    stream.intervals.push_back(static_cast<std::uint16_t>(
        random() % 8 == 0 ? UINT16_MAX - random() % 2 : random() % (2u * kMostTicks)));
  }
  return stream;
}

/// The equations of fold_kernel.hpp, an event at a time.
void foldPlainly(const PackedEvent& event, double clock, double ramp,
                 std::vector<PixelSums>& sums) {
  static const EventFactors kFactors = factors();
  PixelSums& pixel = sums[event.code / 2];
  const double k = kFactors.one_minus[event.code % 2];
  const double weighted_clock = k * clock;
  pixel.sum += pixel.value * (weighted_clock + kFactors.excess[event.code % 2] * ramp);
  pixel.value -= pixel.value * k;
}

void expectSameBits(const std::vector<PixelSums>& sums, const std::vector<PixelSums>& expected) {
  for (std::size_t i = 0; i < kPixels; ++i) {
    EXPECT_EQ(sums[i].sum, expected[i].sum) << "pixel " << i;
    EXPECT_EQ(sums[i].value, expected[i].value) << "pixel " << i;
  }
}

/// Any number of events around the strides, and clocks that fit 32 bits or do not.
constexpr std::int64_t kOffsets_ns[] = {0, -300'000, 2'147'000'000, -2'147'483'648, 40'000'000'000};
constexpr std::size_t kMostEvents = 70;

TEST(FoldKernel, FoldsByTimeLikeTheEquationToTheBit) {
  for (const std::int64_t offset_ns : kOffsets_ns) {
    for (std::size_t count = 0; count <= kMostEvents; ++count) {
      const Stream stream = anyStream(count, static_cast<std::uint32_t>(count) + 1);
      std::vector<PixelSums> sums = noEvents();
      foldByTime(stream.events.data(), count, offset_ns, factors(), sums.data());
      std::vector<PixelSums> expected = noEvents();
      for (const PackedEvent& event : stream.events) {
        foldPlainly(event, static_cast<double>(event.dt_ns + offset_ns), 0.0, expected);
      }
      SCOPED_TRACE(::testing::Message() << count << " events, offset " << offset_ns);
      expectSameBits(sums, expected);
    }
  }
}

TEST(FoldKernel, FoldsRampsLikeTheEquationToTheBit) {
  for (const std::int64_t offset_ns : kOffsets_ns) {
    for (std::size_t count = 0; count <= kMostEvents; ++count) {
      const Stream stream = anyStream(count, static_cast<std::uint32_t>(count) + 1);
      std::vector<PixelSums> sums = noEvents();
      foldRampsByTime(stream.events.data(), stream.intervals.data(), count, offset_ns, factors(),
                      sums.data());
      std::vector<PixelSums> expected = noEvents();
      for (std::size_t i = 0; i < count; ++i) {
        foldPlainly(stream.events[i], static_cast<double>(stream.events[i].dt_ns + offset_ns),
                    std::min(stream.intervals[i], kMostTicks), expected);
      }
      SCOPED_TRACE(::testing::Message() << count << " events, offset " << offset_ns);
      expectSameBits(sums, expected);
    }
  }
}

TEST(FoldKernel, FoldsByCounterLikeTheEquationToTheBit) {
  constexpr std::int64_t kFirst = 1'000'000'007;
  const Stream stream = anyStream(kMostEvents, 1);
  std::vector<PixelSums> sums = noEvents();
  foldByCounter(stream.events.data(), kMostEvents, kFirst, factors(), sums.data());
  std::vector<PixelSums> expected = noEvents();
  for (std::size_t i = 0; i < kMostEvents; ++i) {
    foldPlainly(stream.events[i], static_cast<double>(kFirst + static_cast<std::int64_t>(i)), 0.0,
                expected);
  }
  expectSameBits(sums, expected);
}

}  // namespace
}  // namespace fast_edi
