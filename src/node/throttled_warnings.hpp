/// \file
/// Warnings that may come with every message, written to the log now and then.
#pragma once

#include <cstdint>
#include <string>
#include <unordered_map>
#include <utility>

#include <ros/console.h>

#include "fast_edi/base/types.hpp"

namespace fast_edi {

/// Not ROS_WARN_THROTTLE: that one throttles by a line of source, for all nodelets of a manager
/// together, and by a clock that stands still with a paused bag.
class ThrottledWarnings {
 public:
  static constexpr std::int64_t kInterval_ns = 10 * kNanosecondsPerSecond;

  /// \param name of the node, which begins each line
  explicit ThrottledWarnings(std::string name) : name_(std::move(name)) {}

  /// A line of this kind was written elsewhere.
  void note(const std::string& kind, std::int64_t now_ns) { last_ns_[kind] = now_ns; }

  /// Writes \p text unless one of its kind was written within the interval.
  /// \param now_ns steady clock
  void warn(const std::string& kind, const std::string& text, std::int64_t now_ns) {
    const auto last = last_ns_.find(kind);
    if (last != last_ns_.end() && now_ns - last->second < kInterval_ns) {
      return;
    }
    last_ns_[kind] = now_ns;
    ROS_WARN_STREAM(name_ << ": " << text);
  }

 private:
  std::string name_;
  std::unordered_map<std::string, std::int64_t> last_ns_;
};

}  // namespace fast_edi
