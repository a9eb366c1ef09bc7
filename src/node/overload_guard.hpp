/// \file
/// When it is better not to receive events for a while.
///
/// roscpp reads all connections of a process, and writes to all of them, in one thread, and stays
/// with a connection for as long as it finds whole messages there. A publisher that sends more than
/// the process can receive keeps that thread for itself: frames come in late, and outputs wait in
/// their queues until these overflow. What is received then is dropped anyway. Without those events
/// frames are passed through, and in time.
#pragma once

#include <cstdint>
#include <optional>

namespace fast_edi {

class OverloadGuard {
 public:
  enum class Action { kNone, kSuspend, kResume };

  static constexpr std::int64_t kWindow_ns = 250'000'000;
  /// So many windows in a row make an overload: a burst alone is what buffers are for.
  static constexpr int kWindows = 2;
  static constexpr std::int64_t kPause_ns = 2'000'000'000;
  /// Frames that are expected still: under overload they are late themselves.
  static constexpr std::int64_t kLongestFrameGap_ns = 5'000'000'000;

  /// Totals since the beginning.
  struct Counts {
    std::uint64_t events = 0;
    std::uint64_t events_lost = 0;  ///< of these, for want of room
    std::uint64_t frames = 0;
  };

  /// To be called every few milliseconds. Overload is when more than half of the events are lost
  /// and frames come that needed them: without frames, events are dropped as they grow old.
  /// \return kSuspend and kResume once each, in turn
  Action update(std::int64_t now_ns, const Counts& counts);

 private:
  void beginWindow(std::int64_t now_ns, const Counts& counts);

  bool started_ = false;
  bool suspended_ = false;
  int overloaded_windows_ = 0;
  std::optional<std::int64_t> last_frame_ns_;  ///< the end of the last window with one
  std::int64_t since_ns_ = 0;                  ///< of the window, or of the pause
  Counts before_;
};

}  // namespace fast_edi
