/// \file
/// A camera whose event rate is set while it runs, in the process of whoever receives it: arrays go
/// over as pointers and cost the receiver nothing that it would not pay for a driver's.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <sensor_msgs/Image.h>

#include "fast_edi/base/types.hpp"
#include "fast_edi/messages/event_array.hpp"

namespace fast_edi::load {

using Clock = std::chrono::steady_clock;

constexpr SensorSize kSensor{346, 260};

/// 30 frames/s with exposures of 30 ms. Sensor time passes as the clock on the wall does.
class LoadCamera {
 public:
  struct Sent {
    std::uint64_t events = 0;
    std::uint64_t arrays = 0;
    std::uint64_t frames = 0;
    double seconds = 0.0;
  };

  /// \param ns namespace of the topics
  explicit LoadCamera(const std::string& ns);

  bool hasSubscribers() const;
  /// Arrays of \p events, each sent when there are fewer than two on their way.
  Sent sendAsTaken(std::size_t events, double seconds);
  /// Arrays of 10 ms and 100,000 events at most at that rate, or as near as this thread gets,
  /// whoever takes them.
  Sent sendAtRate(double events_per_second, double seconds);
  /// When the frame with that stamp was sent. \throws std::out_of_range for another stamp
  Clock::time_point sentAt(std::int64_t stamp_ns) const;

 private:
  void begin(std::size_t events, std::int64_t span_ns);
  std::int64_t now() const;
  boost::weak_ptr<const EventArray> sendArray(std::int64_t start_ns);
  void sendDueFrames();

  ros::NodeHandle nh_;
  ros::Publisher events_;
  ros::Publisher image_;
  ros::Publisher exposure_;
  const Clock::time_point zero_;
  std::vector<std::uint8_t> wire_;  ///< the array to be sent next, but for its times
  std::int64_t wire_start_ns_ = 0;
  std::uint32_t sequence_ = 0;
  std::int64_t next_frame_ns_ = 0;  ///< start of the exposure
  sensor_msgs::Image frame_;
  Sent sent_;

  mutable std::mutex mutex_;  ///< guards what is below
  std::map<std::int64_t, Clock::time_point> sent_at_;
};

}  // namespace fast_edi::load
