#include "validation/filter_checks.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "validation/advice.hpp"

namespace fast_edi {
namespace {

/// Bins of a histogram that are compared on either side of an edge.
constexpr std::size_t kSide = 3;
/// Filter times that are looked for.
constexpr double kLeastActivityTime_ns = 0.5 * kMs;
constexpr double kMostActivityTime_ns = 110.0 * kMs;
constexpr double kLeastRefractoryTime_ns = 0.2 * kMs;
constexpr double kMostRefractoryTime_ns = 10.0 * kMs;
/// A break-off: this many times fewer events behind the edge than before it, and enough of them.
constexpr double kBreakOff = 2.0;
/// Times beyond this part of a stretch of events are too often cut off by its end.
constexpr double kCutOff = 0.25;
constexpr std::size_t kTrend = 7;  ///< bins from the edge to where the trend is taken
constexpr std::uint64_t kEnough = 60;
/// Just before the edge there may not be so many times more events than before that: a burst of the
/// whole sensor in step with the frames or the light ends the neighbours' rest at its period, and
/// the times behind that peak are few without any filter.
constexpr double kPeak = 2.2;
constexpr double kLevel = 0.45;
constexpr double kNothing = 0.03;
/// A set-in: at most this part before the edge.
constexpr double kSetIn = 0.03;
/// Events in the first bin behind it, of those in three.
constexpr double kAtOnce = 0.22;
/// Events before that edge, of all.
constexpr double kMostEarlier = 0.01;
/// Pixels whose shortest time lies within an octave above the edge.
constexpr double kOctave = 2.0;
constexpr std::size_t kEnoughEdgePixels = 30;
constexpr double kMissingPolarity = 0.01;
constexpr double kImbalance = 2.0;
constexpr std::uint64_t kEnoughForBalance = 1000;
constexpr std::size_t kListedPixels = 8;  ///< as many as the hardware can mask

/// Natural log of how much less there is behind a bin than before it. A peak just before the bin
/// does not count as a fall: what lies before the peak is compared, too.
double fall(const TimeHistogram& times, std::size_t bin) {
  const std::uint64_t before =
      std::min(times.sum(bin - kSide, bin), times.sum(bin - 2 * kSide, bin - kSide));
  const std::uint64_t behind = times.sum(bin + 1, bin + 1 + kSide);
  return std::log((static_cast<double>(before) + 1.0) / (static_cast<double>(behind) + 1.0));
}

/// True when events pile up just before the bin, where times that chance gives only fall.
bool isBehindPeak(const TimeHistogram& times, std::size_t bin) {
  std::uint64_t highest = 0;
  for (std::size_t i = bin - kSide; i <= bin + 1; ++i) {
    highest = std::max(highest, times[i]);
  }
  const double usual = static_cast<double>(times.sum(bin - 3 * kSide, bin - kSide)) / (2 * kSide);
  return static_cast<double>(highest) > kPeak * usual;
}

/// True when the curve is about level before the bin and behind it, unlike the tail of times that
/// chance gives, which falls faster and faster.
bool isStep(const TimeHistogram& times, std::size_t bin) {
  const auto sum = [&times](std::size_t first) {
    return static_cast<double>(times.sum(first, first + kSide));
  };
  const double before = sum(bin - kSide);
  const double behind = sum(bin + 1);
  const bool level_before = before >= kLevel * sum(bin - 2 * kSide);
  const bool level_behind = sum(bin + 1 + kSide) >= kLevel * behind || behind <= kNothing * before;
  return level_before && level_behind;
}

void checkPolarity(const EventStatistics& statistics, RecordingOrigin origin,
                   std::vector<Finding>& findings) {
  const auto on = static_cast<double>(statistics.on());
  const auto off = static_cast<double>(statistics.off());
  if (statistics.on() + statistics.off() < kEnoughForBalance) {
    return;
  }
  const std::string found =
      textOf("%llu ON, %llu OFF", count(statistics.on()), count(statistics.off()));
  if (polarityIsMissing(statistics)) {
    findings.push_back(
        {"polarity-missing", "ON and OFF events in like numbers", found,
         adviceFor(Remedy::kBothPolarities, origin) +
             (on < off ? " OnBn, which may be too high" : " OffBn, which may be too low") +
             (on >= off && origin == RecordingOrigin::kRosDriver ? " (the stock OFFBn_fine is 0)"
                                                                 : "")});
  } else if (std::max(on, off) > kImbalance * std::min(on, off)) {
    findings.push_back({"polarity-imbalance",
                        textOf("numbers of ON and OFF events within a factor of %.0f", kImbalance),
                        found,
                        adviceFor(Remedy::kBiases, origin) +
                            textOf(" %s; fast_edi: contrast_threshold_%s about %.1f times "
                                   "contrast_threshold_%s",
                                   on > off ? "OffBn (too low) or OnBn (too low)"
                                            : "OnBn (too high) or OffBn (too high)",
                                   on > off ? "off" : "on", std::max(on, off) / std::min(on, off),
                                   on > off ? "on" : "off")});
  }
}

void checkHotPixels(const EventStatistics& statistics, RecordingOrigin origin,
                    std::vector<Finding>& findings) {
  const std::vector<HotPixel> hot = statistics.hotPixels();
  if (hot.empty()) {
    return;
  }
  std::string list;
  for (std::size_t i = 0; i < std::min(hot.size(), kListedPixels); ++i) {
    list += textOf("%s(%d, %d) %.0f/s", i == 0 ? "" : ", ", hot[i].x, hot[i].y, hot[i].rate_hz);
  }
  findings.push_back({"hot-pixels",
                      "no pixel that fires all the time, far more than those around it",
                      textOf("%zu, as (column, row) and rate: %s%s", hot.size(), list.c_str(),
                             hot.size() > kListedPixels ? ", ..." : ""),
                      adviceFor(Remedy::kHotPixelsMasked, origin) +
                          "; fast_edi: filter_despeckle (on by default)"});
}

}  // namespace

std::optional<double> backgroundActivityEdgeNs(const TimeHistogram& times, double longest_ns) {
  std::optional<double> edge_ns;
  double sharpest = std::log(kBreakOff);
  for (std::size_t bin = kTrend + 3 * kSide; bin + 2 * kSide + 1 < TimeHistogram::kBins; ++bin) {
    const double start_ns = TimeHistogram::binStartNs(bin);
    if (start_ns < kLeastActivityTime_ns || start_ns > longest_ns ||
        times.sum(bin - kSide, bin) < kEnough) {
      continue;
    }
    // How fast the curve falls anyway, before the edge.
    const double drop = fall(times, bin) - std::max(0.0, fall(times, bin - kTrend));
    if (drop > sharpest && isStep(times, bin) && !isBehindPeak(times, bin)) {
      sharpest = drop;
      edge_ns = TimeHistogram::binStartNs(bin + 1);
    }
  }
  return edge_ns;
}

std::optional<double> refractoryEdgeNs(const TimeHistogram& times) {
  for (std::size_t bin = kSide; bin + kSide < TimeHistogram::kBins; ++bin) {
    const double start_ns = TimeHistogram::binStartNs(bin);
    if (start_ns < kLeastRefractoryTime_ns || start_ns > kMostRefractoryTime_ns) {
      continue;
    }
    const std::uint64_t before = times.sum(bin - kSide, bin);
    const std::uint64_t behind = times.sum(bin + 1, bin + 1 + kSide);
    const std::uint64_t earlier = times.sum(0, bin);
    // All at once: the first whole bin behind the edge is not far below those that follow.
    if (behind >= kEnough && static_cast<double>(before) <= kSetIn * static_cast<double>(behind) &&
        static_cast<double>(times[bin + 1]) >= kAtOnce * static_cast<double>(behind) &&
        static_cast<double>(earlier) <= kMostEarlier * static_cast<double>(times.total())) {
      return TimeHistogram::binStartNs(bin + 1);
    }
  }
  return std::nullopt;
}

bool polarityIsMissing(const EventStatistics& statistics) {
  const std::uint64_t all = statistics.on() + statistics.off();
  return all >= kEnoughForBalance &&
         static_cast<double>(std::min(statistics.on(), statistics.off())) <
             kMissingPolarity * static_cast<double>(all);
}

std::vector<Finding> checkFilters(const EventStatistics& statistics, double stretch_ns,
                                  RecordingOrigin origin) {
  std::vector<Finding> findings;
  if (const auto edge_ns = backgroundActivityEdgeNs(
          statistics.neighbourTimes(), std::min(kMostActivityTime_ns, kCutOff * stretch_ns))) {
    findings.push_back(
        {"background-activity-filter", "isolated events, too: noise shows that nothing was removed",
         textOf("events whose neighbours' last lies more than %.1f ms back are suddenly few",
                *edge_ns / kMs),
         adviceFor(Remedy::kBackgroundActivityFilterOff, origin) +
             "; the first events of edges are missing"});
  }
  const auto edge_ns = refractoryEdgeNs(statistics.pixelTimes());
  // A few hot pixels with a beat of their own are no filter.
  if (edge_ns && statistics.pixelsWithShortest(*edge_ns, kOctave * *edge_ns) >= kEnoughEdgePixels) {
    findings.push_back(
        {"refractory-filter", "events of a pixel within 0.2 ms of each other, too",
         textOf("none within %.2f ms of the pixel's last, many from there on", *edge_ns / kMs),
         adviceFor(Remedy::kRefractoryFilterOff, origin) + "; fast edges are missing events"});
  }
  checkPolarity(statistics, origin, findings);
  checkHotPixels(statistics, origin, findings);
  return findings;
}

}  // namespace fast_edi
