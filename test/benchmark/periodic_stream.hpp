/// \file
/// Events of a periodic camera as wire records that can be played without end.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "fast_edi/base/types.hpp"
#include "fast_edi/events/event_wire.hpp"
#include "support/event_generators.hpp"

namespace fast_edi::benchmarks {

constexpr std::int64_t kPeriod_ns = 40 * kNanosecondsPerMillisecond;
constexpr std::int64_t kExposure_ns = 30 * kNanosecondsPerMillisecond;
constexpr std::int64_t kPacket_ns = kNanosecondsPerMillisecond;
/// Exposures start here within the period: inside a packet.
constexpr std::int64_t kExposureOffset_ns = 1'400 * kNanosecondsPerMicrosecond;

struct StreamSettings {
  testing::EventScene scene = testing::EventScene::kUniform;
  SensorSize size;
  std::size_t events_per_exposure = 0;

  friend bool operator==(const StreamSettings& a, const StreamSettings& b) {
    return a.scene == b.scene && a.size == b.size && a.events_per_exposure == b.events_per_exposure;
  }
};

/// One camera period of events, in packets of kPacket_ns. next() moves all stamps on by a period.
class PeriodicStream {
 public:
  explicit PeriodicStream(const StreamSettings& settings);
  /// \param events of one period, sorted, from time 0 on
  PeriodicStream(SensorSize size, std::vector<Event> events);

  std::size_t packetCount() const { return packet_begin_.size() - 1; }
  WireEvents packet(std::size_t index) const;
  /// All packets at once.
  WireEvents all() const { return testing::wireView(wire_); }
  /// Start of the period at hand [ns].
  std::int64_t start() const { return start_ns_; }
  /// The exposure of the period at hand.
  ExposureInterval exposure() const {
    return {start_ns_ + kExposureOffset_ns, start_ns_ + kExposureOffset_ns + kExposure_ns};
  }
  const StreamSettings& settings() const { return settings_; }

  void next();

 private:
  void pack(const std::vector<Event>& events);

  StreamSettings settings_;
  std::int64_t start_ns_;
  std::vector<std::uint8_t> wire_;
  std::vector<std::size_t> packet_begin_;  ///< one more than packets
};

/// The stream for \p settings; the last one asked for is kept, since making one takes longer than
/// measuring with it. Its time goes on from use to use.
PeriodicStream& sharedStream(const StreamSettings& settings);

/// "346x260"
std::string toString(SensorSize size);

}  // namespace fast_edi::benchmarks
