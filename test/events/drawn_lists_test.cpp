/// The picture of the lists in src/method.md shows what the code computes.
#include <gmock/gmock.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "fast_edi/events/pixel_event_lists.hpp"
#include "fast_edi/integral/double_integral.hpp"

namespace fast_edi {
namespace {

using ::testing::HasSubstr;
using ::testing::SizeIs;

constexpr SensorSize kSize{2, 1};
constexpr ContrastThresholds kThresholds{0.26, 0.24};
constexpr ExposureInterval kExposure{0, 30 * kNanosecondsPerMillisecond};
constexpr std::int64_t kReference_ns = 15 * kNanosecondsPerMillisecond;

std::string picture() {
  std::ifstream file(std::string(FAST_EDI_SOURCE_DIR) + "/.doc/lists.svg");
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

Event eventAt(double time_ms, int x, bool on) {
  return {static_cast<std::uint16_t>(x), 0, static_cast<std::int64_t>(time_ms * 1e6), on};
}

/// The events of `.doc/draw_lists`: the pixel is (0, 0), elsewhere is (1, 0).
std::vector<Event> drawnEvents() {
  std::vector<Event> events = {eventAt(5.0, 0, true), eventAt(9.0, 0, true), eventAt(11.5, 0, true),
                               eventAt(18.0, 0, false), eventAt(22.0, 0, false)};
  for (const double time_ms : {1.4, 3.1, 6.2, 7.0, 7.9, 9.8, 10.4, 12.6, 13.3, 14.0, 15.7, 16.4,
                               19.1, 20.2, 20.9, 23.3, 25.0, 26.8, 28.1}) {
    events.push_back(eventAt(time_ms, 1, true));
  }
  std::sort(events.begin(), events.end(),
            [](const Event& a, const Event& b) { return a.t_ns < b.t_ns; });
  return events;
}

void fill(PixelEventLists& lists) {
  for (const Event& event : drawnEvents()) {
    ASSERT_EQ(lists.append(event).accepted, 1u);
  }
}

template <typename... Values>
std::string formatted(const char* format, Values... values) {
  char text[64];
  std::snprintf(text, sizeof(text), format, values...);
  return text;
}

TEST(DrawnLists, ShowsThePairsOfTheList) {
  PixelEventLists lists(kSize, {});
  fill(lists);
  const std::vector<ListEntry> entries = lists.list(0, 0, kExposure, kThresholds);
  ASSERT_THAT(entries, SizeIs(5));
  const std::string shown = picture();
  EXPECT_THAT(shown, HasSubstr(">&lt;1.00, 0&gt;<"));
  for (const ListEntry& entry : entries) {
    EXPECT_THAT(shown, HasSubstr(formatted(">&lt;%.2f, %d&gt;<", entry.exp_value,
                                           static_cast<int>(entry.counter))));
  }
}

TEST(DrawnLists, ShowsTheDoubleIntegral) {
  PixelEventLists lists(kSize, {});
  fill(lists);
  const std::string shown = picture();
  for (const Weighting weighting : {Weighting::kTime, Weighting::kCounter}) {
    DoubleIntegral integral(kSize, kThresholds, weighting);
    std::vector<float> gain(kSize.pixelCount());
    integral.integrate(lists, kExposure, kReference_ns, gain.data());
    EXPECT_THAT(shown, HasSubstr(formatted("= %.3f", 1.0 / static_cast<double>(gain[0]))));
  }
}

}  // namespace
}  // namespace fast_edi
