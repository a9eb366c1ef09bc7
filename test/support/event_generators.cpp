#include "support/event_generators.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <random>

namespace fast_edi::testing {

namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr std::size_t kEdgeCount = 6;
constexpr std::size_t kBurstCount = 20;
/// A burst lasts this part of its share of the stream.
constexpr std::int64_t kBurstDutyDivisor = 10;
constexpr int kBurstPatchPx = 64;
constexpr int kWalkPatchPx = 8;

class SpecRandom {
 public:
  explicit SpecRandom(std::uint64_t seed) : engine_(seed) {}
  /// In [0, bound), from the high bits. \pre 0 < bound < 2^32
  std::uint64_t below(std::uint64_t bound) { return ((engine_() >> 32) * bound) >> 32; }
  bool flip() { return (engine_() >> 63) != 0; }
  /// In [0, 1).
  double unit() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }

 private:
  std::mt19937_64 engine_;
};

/// Time of event i: its even share of the stream plus jitter within it, in whole microseconds.
std::int64_t timeOf(std::size_t i, const EventSpec& spec, SpecRandom& random) {
  const double share = (static_cast<double>(i) + random.unit()) / static_cast<double>(spec.count);
  const std::int64_t offset_us = static_cast<std::int64_t>(
      share * static_cast<double>(spec.duration_ns / kNanosecondsPerMicrosecond));
  return spec.start_ns + offset_us * kNanosecondsPerMicrosecond;
}

Event randomEvent(int x0, int y0, int width, int height, std::int64_t t_ns, SpecRandom& random) {
  const std::uint64_t pixel = random.below(static_cast<std::uint64_t>(width) * height);
  return {static_cast<std::uint16_t>(x0 + static_cast<int>(pixel % width)),
          static_cast<std::uint16_t>(y0 + static_cast<int>(pixel / width)), t_ns, random.flip()};
}

std::vector<Event> uniformEvents(const EventSpec& spec, SpecRandom& random) {
  std::vector<Event> events;
  events.reserve(spec.count);
  for (std::size_t i = 0; i < spec.count; ++i) {
    const std::int64_t t_ns = timeOf(i, spec, random);
    events.push_back(randomEvent(0, 0, spec.size.width, spec.size.height, t_ns, random));
  }
  return events;
}

/// A straight line that sweeps over the sensor and starts again at the other side.
struct Edge {
  double normal_x, normal_y;
  double offset_px, sweeps;
};

std::vector<Event> movingEdges(const EventSpec& spec, SpecRandom& random) {
  const double width = spec.size.width;
  const double height = spec.size.height;
  const double radius = 0.5 * std::hypot(width, height);
  std::array<Edge, kEdgeCount> edges;
  for (Edge& edge : edges) {
    const double angle = 2.0 * kPi * random.unit();
    edge = {std::cos(angle), std::sin(angle), 2.0 * radius * random.unit(), 0.5 + random.unit()};
  }
  std::vector<bool> next_on(spec.size.pixelCount(), true);
  std::vector<Event> events;
  events.reserve(spec.count);
  for (std::size_t i = 0; i < spec.count; ++i) {
    const std::int64_t t_ns = timeOf(i, spec, random);
    const double phase =
        static_cast<double>(t_ns - spec.start_ns) / static_cast<double>(spec.duration_ns);
    int x = -1, y = -1;
    while (x < 0 || y < 0 || x >= spec.size.width || y >= spec.size.height) {
      const Edge& edge = edges[random.below(kEdgeCount)];
      const double sweep = edge.offset_px + edge.sweeps * phase * 2.0 * radius;
      const double across = std::fmod(sweep, 2.0 * radius) - radius + (2.0 * random.unit() - 1.0);
      const double along = radius * (2.0 * random.unit() - 1.0);
      x = static_cast<int>(
          std::floor(0.5 * width + across * edge.normal_x - along * edge.normal_y));
      y = static_cast<int>(
          std::floor(0.5 * height + across * edge.normal_y + along * edge.normal_x));
    }
    const std::size_t pixel = static_cast<std::size_t>(y) * spec.size.width + x;
    events.push_back({static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y), t_ns,
                      static_cast<bool>(next_on[pixel])});
    next_on[pixel] = !next_on[pixel];
  }
  return events;
}

std::vector<Event> hotPixel(const EventSpec& spec, bool alternate, SpecRandom& random) {
  const auto x = static_cast<std::uint16_t>(spec.size.width / 2);
  const auto y = static_cast<std::uint16_t>(spec.size.height / 2);
  std::vector<Event> events;
  events.reserve(spec.count);
  for (std::size_t i = 0; i < spec.count; ++i) {
    const std::int64_t t_ns = timeOf(i, spec, random);
    events.push_back({x, y, t_ns, alternate ? i % 2 == 0 : random.flip()});
  }
  return events;
}

std::vector<Event> bursts(const EventSpec& spec, SpecRandom& random) {
  const int width = std::min(kBurstPatchPx, spec.size.width);
  const int height = std::min(kBurstPatchPx, spec.size.height);
  const std::int64_t burst_ns = spec.duration_ns / static_cast<std::int64_t>(kBurstCount);
  std::vector<Event> events;
  events.reserve(spec.count);
  for (std::size_t burst = 0; burst < kBurstCount; ++burst) {
    const int x0 = static_cast<int>(random.below(spec.size.width - width + 1));
    const int y0 = static_cast<int>(random.below(spec.size.height - height + 1));
    const std::size_t end = spec.count * (burst + 1) / kBurstCount;
    const std::size_t count = end - events.size();
    const EventSpec part{spec.size, count,
                         spec.start_ns + burst_ns * static_cast<std::int64_t>(burst),
                         burst_ns / kBurstDutyDivisor, spec.seed};
    for (std::size_t i = 0; i < count; ++i) {
      Event event = randomEvent(x0, y0, width, height, timeOf(i, part, random), random);
      event.on = burst % 2 == 0;
      events.push_back(event);
    }
  }
  return events;
}

std::vector<Event> randomWalks(const EventSpec& spec, SpecRandom& random) {
  const int width = std::min(kWalkPatchPx, spec.size.width);
  const int height = std::min(kWalkPatchPx, spec.size.height);
  std::vector<Event> events;
  events.reserve(spec.count);
  for (std::size_t i = 0; i < spec.count; ++i) {
    const std::int64_t t_ns = timeOf(i, spec, random);
    events.push_back(randomEvent(0, 0, width, height, t_ns, random));
  }
  return events;
}

}  // namespace

const char* toString(EventScene scene) {
  switch (scene) {
    case EventScene::kUniform:
      return "uniform";
    case EventScene::kMovingEdges:
      return "edges";
    case EventScene::kHotPixel:
      return "hot_pixel";
    case EventScene::kHotWalk:
      return "hot_walk";
    case EventScene::kBursts:
      return "bursts";
    case EventScene::kRandomWalks:
      return "random_walks";
  }
  return "unknown";
}

std::vector<Event> makeEvents(EventScene scene, const EventSpec& spec) {
  SpecRandom random(spec.seed);
  switch (scene) {
    case EventScene::kUniform:
      return uniformEvents(spec, random);
    case EventScene::kMovingEdges:
      return movingEdges(spec, random);
    case EventScene::kHotPixel:
      return hotPixel(spec, true, random);
    case EventScene::kHotWalk:
      return hotPixel(spec, false, random);
    case EventScene::kBursts:
      return bursts(spec, random);
    case EventScene::kRandomWalks:
      return randomWalks(spec, random);
  }
  return {};
}

std::vector<std::uint8_t> toWire(const std::vector<Event>& events) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(events.size() * kWireEventBytes);
  for (const Event& event : events) encodeWireEvent(event, bytes);
  return bytes;
}

WireEvents wireView(const std::vector<std::uint8_t>& bytes) {
  return {bytes.data(), bytes.size() / kWireEventBytes};
}

void shiftStamps(std::int64_t by_ns, std::uint8_t* records, std::size_t count) {
  constexpr std::size_t kSecondsOffset = 4;
  constexpr std::size_t kNanosecondsOffset = 8;
  const auto by_sec = static_cast<std::uint32_t>(by_ns / kNanosecondsPerSecond);
  const auto by_nsec = static_cast<std::uint32_t>(by_ns % kNanosecondsPerSecond);
  for (std::size_t i = 0; i < count; ++i) {
    std::uint8_t* record = records + i * kWireEventBytes;
    std::uint32_t sec, nsec;
    std::memcpy(&sec, record + kSecondsOffset, sizeof sec);
    std::memcpy(&nsec, record + kNanosecondsOffset, sizeof nsec);
    sec += by_sec;
    nsec += by_nsec;
    if (nsec >= kNanosecondsPerSecond) {
      nsec -= static_cast<std::uint32_t>(kNanosecondsPerSecond);
      ++sec;
    }
    std::memcpy(record + kSecondsOffset, &sec, sizeof sec);
    std::memcpy(record + kNanosecondsOffset, &nsec, sizeof nsec);
  }
}

void shiftStamps(std::int64_t by_ns, std::vector<std::uint8_t>& bytes) {
  shiftStamps(by_ns, bytes.data(), bytes.size() / kWireEventBytes);
}

std::vector<std::uint8_t> makeGreyImage(SensorSize size, std::uint64_t seed) {
  constexpr std::uint64_t kDarkest = 20;
  constexpr std::uint64_t kLevels = 200;
  SpecRandom random(seed);
  std::vector<std::uint8_t> image(size.pixelCount());
  for (std::uint8_t& pixel : image) {
    pixel = static_cast<std::uint8_t>(kDarkest + random.below(kLevels));
  }
  return image;
}

}  // namespace fast_edi::testing
