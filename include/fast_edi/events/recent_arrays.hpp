/// \file
/// Event arrays that come again with the same content: a topic that two nodes publish, a recording
/// that is played twice at a time or holds each array twice.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "fast_edi/events/event_wire.hpp"

namespace fast_edi {

/// The last arrays, each known by its size and by eight of its events, the first and the last among
/// them. Arrays of a sensor that agree in that agree in all. O(1) for each array.
class RecentArrays {
 public:
  /// Half a second of arrays of 8 ms.
  static constexpr std::size_t kArrays = 64;
  static constexpr std::size_t kSamples = 8;

  /// \pre events are not empty
  void add(const WireEvents& events) {
    arrays_[next_] = identityOf(events);
    next_ = (next_ + 1) % kArrays;
  }
  /// Whether one of the last kArrays arrays that were added has this content. \pre events are not
  /// empty
  bool contains(const WireEvents& events) const {
    const Identity identity = identityOf(events);
    return std::any_of(arrays_.begin(), arrays_.end(), [&identity](const Identity& array) {
      return array.count == identity.count && array.samples == identity.samples;
    });
  }
  void clear() { arrays_.fill({}); }

 private:
  struct Identity {
    std::size_t count = 0;  ///< 0: none
    std::array<std::uint8_t, kSamples * kWireEventBytes> samples{};
  };
  static Identity identityOf(const WireEvents& events) {
    Identity identity;
    identity.count = events.count;
    for (std::size_t i = 0; i < kSamples; ++i) {
      std::memcpy(identity.samples.data() + i * kWireEventBytes,
                  events.record((events.count - 1) * i / (kSamples - 1)), kWireEventBytes);
    }
    return identity;
  }

  std::array<Identity, kArrays> arrays_{};
  std::size_t next_ = 0;
};

}  // namespace fast_edi
