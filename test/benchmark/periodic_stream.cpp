#include "periodic_stream.hpp"

#include <algorithm>
#include <memory>

namespace fast_edi::benchmarks {

namespace {

constexpr std::int64_t kFirstStart_ns = 1'000'000'000 * kNanosecondsPerSecond;
constexpr std::uint64_t kSeed = 1;

}  // namespace

PeriodicStream::PeriodicStream(const StreamSettings& settings)
    : settings_(settings), start_ns_(kFirstStart_ns) {
  const auto count = static_cast<std::size_t>(
      static_cast<std::int64_t>(settings.events_per_exposure) * kPeriod_ns / kExposure_ns);
  pack(testing::makeEvents(settings.scene, {settings.size, count, start_ns_, kPeriod_ns, kSeed}));
}

PeriodicStream::PeriodicStream(SensorSize size, std::vector<Event> events)
    : start_ns_(kFirstStart_ns) {
  settings_.size = size;
  for (Event& event : events) {
    event.t_ns += start_ns_;
  }
  pack(events);
}

void PeriodicStream::pack(const std::vector<Event>& events) {
  wire_ = testing::toWire(events);
  for (std::int64_t begin_ns = 0; begin_ns <= kPeriod_ns; begin_ns += kPacket_ns) {
    const auto first =
        std::lower_bound(events.begin(), events.end(), start_ns_ + begin_ns,
                         [](const Event& event, std::int64_t t_ns) { return event.t_ns < t_ns; });
    packet_begin_.push_back(static_cast<std::size_t>(first - events.begin()));
  }
}

WireEvents PeriodicStream::packet(std::size_t index) const {
  return {wire_.data() + packet_begin_[index] * kWireEventBytes,
          packet_begin_[index + 1] - packet_begin_[index]};
}

void PeriodicStream::next() {
  testing::shiftStamps(kPeriod_ns, wire_);
  start_ns_ += kPeriod_ns;
}

PeriodicStream& sharedStream(const StreamSettings& settings) {
  static std::unique_ptr<PeriodicStream> kept;
  if (!kept || !(kept->settings() == settings)) {
    kept.reset();  // before the next one is made: one takes up to 600 MB
    kept = std::make_unique<PeriodicStream>(settings);
  }
  return *kept;
}

std::string toString(SensorSize size) {
  return std::to_string(size.width) + "x" + std::to_string(size.height);
}

}  // namespace fast_edi::benchmarks
