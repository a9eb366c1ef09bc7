#include "node/comparison_view.hpp"

#include <algorithm>

#include <opencv2/core.hpp>

#include "fast_edi/messages/image_pixels.hpp"

namespace fast_edi {
namespace {

/// Each event takes this much of the other two colours, so that some four events saturate.
constexpr int kShadePerEvent_dn = 64;

void darken(std::uint8_t& channel) {
  channel = static_cast<std::uint8_t>(std::max(0, channel - kShadePerEvent_dn));
}

}  // namespace

void ComparisonView::addEvents(const WireEvents& events, SensorSize size,
                               const EventMapping& mapping) {
  const WireEvents recent =
      events.count > kMaxEvents ? events.from(events.count - kMaxEvents) : events;
  if (recent.empty()) {
    return;
  }
  arrays_.emplace_back(recent.data, recent.data + recent.count * kWireEventBytes);
  if (!mapping.isIdentity()) {
    mapping.apply(arrays_.back().data(), recent.count, size);
  }
  event_count_ += recent.count;
  while (event_count_ > kMaxEvents) {
    event_count_ -= arrays_.front().size() / kWireEventBytes;
    arrays_.pop_front();
  }
}

void ComparisonView::clear() {
  arrays_.clear();
  event_count_ = 0;
}

sensor_msgs::ImagePtr ComparisonView::draw(const sensor_msgs::Image& input,
                                           const sensor_msgs::Image& output,
                                           const ExposureInterval& window) const {
  const cv::Mat blurry = colourPixels(input);
  const cv::Mat latent = colourPixels(output);
  cv::Mat drawn(blurry.size(), CV_8UC3, cv::Scalar::all(255));
  for (const std::vector<std::uint8_t>& array : arrays_) {
    const WireEvents events{array.data(), array.size() / kWireEventBytes};
    for (std::size_t i = 0; i < events.count; ++i) {
      const Event event = decodeWireEvent(events.record(i));
      if (event.t_ns < window.start_ns || event.t_ns >= window.end_ns || event.x >= drawn.cols ||
          event.y >= drawn.rows) {
        continue;
      }
      cv::Vec3b& pixel = drawn.at<cv::Vec3b>(event.y, event.x);
      darken(pixel[1]);
      darken(pixel[event.on ? 0 : 2]);
    }
  }
  cv::Mat picture;
  cv::hconcat(std::vector<cv::Mat>{blurry, drawn, latent}, picture);
  return colourMessage(output.header, picture);
}

}  // namespace fast_edi
