#include "calibration/pair_evidence.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "fast_edi/events/pixel_event_lists.hpp"

namespace fast_edi {
namespace {

constexpr std::int64_t kMs = kNanosecondsPerMillisecond;
constexpr ContrastThresholds kThresholds{0.25, 0.2};
constexpr ExposurePair kPair{{10 * kMs, 30 * kMs}, {45 * kMs, 60 * kMs}, 20 * kMs, 50 * kMs};
const LevelModel kStaircase{};
const LevelModel kRamp{4 * kMs, 0.85};

/// Events of random pixels and times, from before the first exposure to after the second.
std::vector<Event> randomEvents(SensorSize size, std::size_t count) {
  std::mt19937 random(7);
  std::vector<Event> events(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto t_ns = static_cast<std::int64_t>(i * static_cast<std::size_t>(70 * kMs) / count);
    events[i] = {static_cast<std::uint16_t>(random() % static_cast<unsigned>(size.width)),
                 static_cast<std::uint16_t>(random() % static_cast<unsigned>(size.height)), t_ns,
                 random() % 2 == 0};
  }
  return events;
}

std::unique_ptr<PixelEventLists> listsOf(SensorSize size, const std::vector<Event>& events) {
  auto lists = std::make_unique<PixelEventLists>(size, PixelEventLists::Limits{});
  lists->keepIntervals(true);
  for (const Event& event : events) {
    lists->append(event);
  }
  return lists;
}

/// w(t) of online_calibration.hpp.
double weightAt(double t_ns) {
  const auto start1 = static_cast<double>(kPair.first.start_ns);
  const auto end1 = static_cast<double>(kPair.first.end_ns);
  const auto start2 = static_cast<double>(kPair.second.start_ns);
  const auto end2 = static_cast<double>(kPair.second.end_ns);
  return t_ns < end1     ? std::max(0.0, (t_ns - start1) / (end1 - start1))
         : t_ns < start2 ? 1.0
                         : std::max(0.0, (end2 - t_ns) / (end2 - start2));
}

/// The sums of one pixel in double precision, straight from their definitions.
struct Reference {
  double weight[2] = {0.0, 0.0};
  double slope = 0.0;
  double level = 0.0;
  double count = 0.0;
};

std::vector<Reference> reference(SensorSize size, const std::vector<Event>& events,
                                 const LevelModel& level) {
  std::vector<Reference> pixels(size.pixelCount());
  std::vector<std::int64_t> last_ns(size.pixelCount(), INT64_MIN / 2);
  for (const Event& event : events) {
    const std::size_t at =
        static_cast<std::size_t>(event.y) * static_cast<std::size_t>(size.width) +
        static_cast<std::size_t>(event.x);
    // As ticks are counted: whole ones, less one.
    const std::int64_t interval =
        std::clamp<std::int64_t>((event.t_ns >> 8) - (last_ns[at] >> 8) - 1, 0, kMostIntervalTicks);
    last_ns[at] = event.t_ns;
    if (event.t_ns < kPair.first.start_ns || event.t_ns >= kPair.second.end_ns) {
      continue;
    }
    const auto ticks = static_cast<std::uint16_t>(level.isStaircase() ? std::int64_t{0} : interval);
    const double step = kThresholds.step(event.on);
    const double mean_ns = static_cast<double>(event.t_ns) -
                           0.5 * level.fraction * static_cast<double>(level.rampBefore(ticks));
    Reference& pixel = pixels[at];
    pixel.weight[event.on ? 1 : 0] += weightAt(mean_ns);
    const double ms = static_cast<double>(kMs);
    if (mean_ns < static_cast<double>(kPair.first.end_ns)) {
      pixel.slope -= step * ms / static_cast<double>(kPair.first.length());
    } else if (mean_ns >= static_cast<double>(kPair.second.start_ns)) {
      pixel.slope += step * ms / static_cast<double>(kPair.second.length());
    }
    if (event.t_ns >= kPair.first_reference_ns) {
      pixel.level +=
          step *
          (level.reached(event.t_ns, ticks, {kPair.second_reference_ns, kPair.second.end_ns}) -
           level.reached(event.t_ns, ticks, {kPair.first_reference_ns, kPair.first.end_ns}));
    }
    pixel.count += 1.0;
  }
  return pixels;
}

void expectEqual(const PairEvidence::Pixel& found, const Reference& expected,
                 const std::string& where) {
  constexpr double kRounding = 1e-3;
  EXPECT_EQ(static_cast<double>(found.count), expected.count) << where;
  EXPECT_NEAR(static_cast<double>(found.weight[0]), expected.weight[0], kRounding) << where;
  EXPECT_NEAR(static_cast<double>(found.weight[1]), expected.weight[1], kRounding) << where;
  EXPECT_NEAR(static_cast<double>(found.slope), expected.slope, kRounding) << where;
  EXPECT_NEAR(static_cast<double>(found.level), expected.level, kRounding) << where;
}

TEST(PairEvidence, SumsAreThoseOfTheDefinition) {
  // More events than one block and one chunk of the log hold.
  constexpr SensorSize kSize{37, 23};
  const std::vector<Event> events = randomEvents(kSize, 40'000);
  const auto lists = listsOf(kSize, events);
  for (const LevelModel& level : {kStaircase, kRamp}) {
    const std::vector<Reference> expected = reference(kSize, events, level);
    PairEvidence evidence(kSize);
    evidence.gather(*lists, kPair, kThresholds, level, {});
    for (int y = 0; y < kSize.height; ++y) {
      for (int x = 0; x < kSize.width; ++x) {
        expectEqual(evidence.row(y)[x], expected[static_cast<std::size_t>(y * kSize.width + x)],
                    std::to_string(x) + ", " + std::to_string(y));
      }
    }
  }
}

TEST(PairEvidence, BelongsAtABorderToWhatBegins) {
  constexpr SensorSize kSize{5, 1};
  std::vector<Event> events;
  for (const std::int64_t border_ns :
       {kPair.first.start_ns, kPair.first.end_ns, kPair.second.start_ns, kPair.second.end_ns}) {
    const auto x = static_cast<std::uint16_t>(events.size());
    events.push_back({x, 0, border_ns, true});
  }
  PairEvidence evidence(kSize);
  evidence.gather(*listsOf(kSize, events), kPair, kThresholds, kStaircase, {});
  const std::vector<Reference> expected = reference(kSize, events, kStaircase);
  for (std::size_t x = 0; x < expected.size(); ++x) {
    expectEqual(evidence.row(0)[x], expected[x], std::to_string(x));
  }
  EXPECT_NE(evidence.row(0)[0].slope, 0.0F);
  EXPECT_EQ(evidence.row(0)[1].slope, 0.0F);
  EXPECT_NE(evidence.row(0)[2].slope, 0.0F);
  EXPECT_EQ(evidence.row(0)[3].count, 0.0F);
}

TEST(PairEvidence, RowsOfASampleHaveTheSameSumsAsAmongAll) {
  for (const SensorSize size : {SensorSize{37, 23}, SensorSize{346, 260}, SensorSize{3000, 2000},
                                SensorSize{1, 30000}, SensorSize{30000, 8}}) {
    const auto lists = listsOf(size, randomEvents(size, 30'000));
    PairEvidence all(size);
    all.gather(*lists, kPair, kThresholds, kRamp, {});
    PairEvidence some(size);
    for (const RowSample rows : {RowSample{0, 3}, RowSample{2, 3}, RowSample{5, size.height}}) {
      some.gather(*lists, kPair, kThresholds, kRamp, rows);
      std::size_t counted = 0;
      for (int y = rows.first; y < size.height; y += rows.step) {
        for (int x = 0; x < size.width; ++x) {
          const PairEvidence::Pixel& a = some.row(y)[x];
          const PairEvidence::Pixel& b = all.row(y)[x];
          ASSERT_TRUE(a.weight[0] == b.weight[0] && a.weight[1] == b.weight[1] &&
                      a.slope == b.slope && a.level == b.level && a.count == b.count)
              << x << ", " << y << " of " << size.width << "x" << size.height;
          counted += static_cast<std::size_t>(a.count);
        }
      }
      EXPECT_GT(counted, 0u);
    }
  }
}

TEST(PairEvidence, NothingRemainsOfThePairBefore) {
  constexpr SensorSize kSize{37, 23};
  const auto lists = listsOf(kSize, randomEvents(kSize, 5'000));
  PairEvidence evidence(kSize);
  evidence.gather(*lists, kPair, kThresholds, kRamp, {});
  evidence.gather(*listsOf(kSize, {}), kPair, kThresholds, kRamp, {1, 2});
  for (int y = 1; y < kSize.height; y += 2) {
    for (int x = 0; x < kSize.width; ++x) {
      EXPECT_EQ(evidence.row(y)[x].count, 0.0F) << x << ", " << y;
    }
  }
}

}  // namespace
}  // namespace fast_edi
