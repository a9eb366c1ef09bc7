#include "survey/event_statistics.hpp"

#include <algorithm>

namespace fast_edi {

EventStatistics::EventStatistics(SensorSize size) : size_(size), activity_(size), times_(size) {}

void EventStatistics::restart(std::int64_t t_ns) {
  activity_.restart(t_ns);
  times_.restart(t_ns);
  started_ = true;
}

void EventStatistics::add(const Event& event) {
  largest_x_ = std::max(largest_x_, static_cast<int>(event.x));
  largest_y_ = std::max(largest_y_, static_cast<int>(event.y));
  if (event.x >= size_.width || event.y >= size_.height) {
    ++outside_;
    return;
  }
  if (!started_) {
    restart(event.t_ns);
  }
  ++(event.on ? on_ : off_);
  activity_.add(event);
  times_.add(event);
}

}  // namespace fast_edi
