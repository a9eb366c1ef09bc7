/// \file
/// The picture on the `comparison` topic: input, events of the exposure, and output side by side.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <vector>

#include <sensor_msgs/Image.h>

#include "fast_edi/base/types.hpp"
#include "fast_edi/events/event_mapping.hpp"
#include "fast_edi/events/event_wire.hpp"

namespace fast_edi {

/// Stores recent events itself, since those of the pipeline may be discarded once a frame is
/// closed. Used only while the topic has a subscriber.
class ComparisonView {
 public:
  /// Older events are discarded: a picture of a longer exposure shows its last ones.
  static constexpr std::size_t kMaxEvents = 1'000'000;

  /// \param size as the event array states it
  void addEvents(const WireEvents& events, SensorSize size, const EventMapping& mapping);
  /// Discards all events.
  void clear();

  /// A bgr8 image of three times the input's width. ON events are red, OFF events blue, stronger
  /// where there are more.
  /// \param window the exposure in event time
  /// \pre input and output are supported images of the same size
  /// \throws cv::Exception, std::invalid_argument when they are not
  sensor_msgs::ImagePtr draw(const sensor_msgs::Image& input, const sensor_msgs::Image& output,
                             const ExposureInterval& window) const;

 private:
  std::deque<std::vector<std::uint8_t>> arrays_;  ///< wire records, oldest array first
  std::size_t event_count_ = 0;
};

}  // namespace fast_edi
