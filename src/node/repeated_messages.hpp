/// \file
/// Messages that are delivered twice.
///
/// roscpp (seen with 1.15.15) connects a publisher and a subscriber of one process twice if one of
/// them advertises while the other one subscribes: TopicManager::advertise() and
/// TopicManager::subscribe() each find the other's entry, and each adds a connection. From then on
/// everything comes twice. A nodelet manager that loads a driver while a lazy nodelet begins to
/// listen does just that.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <cstring>
#include <utility>

#include <boost/smart_ptr/shared_ptr.hpp>
#include <boost/smart_ptr/weak_ptr.hpp>

#include "fast_edi/events/event_wire.hpp"

namespace fast_edi {

/// For people, behind what came.
constexpr const char* kCameTwice =
    " came twice and were dropped once: roscpp connected a publisher of this process twice, which "
    "advertised while this nodelet subscribed";

/// Messages that both connections deliver as the same pointer.
class RepeatedPointers {
 public:
  /// Whether this message is the one of the call before.
  bool repeats(const boost::shared_ptr<const void>& message) {
    const bool same = last_.lock() == message;
    last_ = message;
    return same;
  }

 private:
  boost::weak_ptr<const void> last_;  // so that no message lives longer
};

/// Frames and their exposure times. Frames may come on another thread than exposure times.
class RepeatedFrames {
 public:
  bool repeatsImage(const boost::shared_ptr<const void>& image) {
    if (images_.repeats(image)) {
      return true;
    }
    ++frames_;
    return false;
  }
  /// A message that comes again behind another frame is no repetition: a nodelet may publish one
  /// message for as long as the exposure time does not change.
  bool repeatsExposure(const boost::shared_ptr<const void>& exposure) {
    const std::uint64_t before = std::exchange(frames_at_exposure_, frames_.load());
    return exposures_.repeats(exposure) && frames_at_exposure_ == before;
  }

 private:
  RepeatedPointers images_;
  RepeatedPointers exposures_;
  std::atomic<std::uint64_t> frames_{0};
  std::uint64_t frames_at_exposure_ = 0;
};

/// Event arrays: each connection may decode its own.
class RepeatedArrays {
 public:
  /// Whether an array is that of the call before, by its number, its size, its first and its last
  /// event. Empty arrays say nothing.
  bool repeats(const WireEvents& events, std::uint32_t sequence) {
    if (events.count == 0) {
      return false;
    }
    Identity identity{sequence, events.count, {}};
    std::memcpy(identity.ends.data(), events.record(0), kWireEventBytes);
    std::memcpy(identity.ends.data() + kWireEventBytes, events.record(events.count - 1),
                kWireEventBytes);
    const bool same = identity.sequence == last_.sequence && identity.count == last_.count &&
                      identity.ends == last_.ends;
    last_ = identity;
    return same;
  }

 private:
  struct Identity {
    std::uint32_t sequence = 0;
    std::size_t count = 0;  ///< 0: no array yet
    std::array<std::uint8_t, 2 * kWireEventBytes> ends{};
  };
  Identity last_;
};

}  // namespace fast_edi
