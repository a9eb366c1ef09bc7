#include "recording/rosbag2_frames.hpp"

#include <algorithm>

#include "fast_edi/exposure/stamp_limits.hpp"
#include "recording/cdr_messages.hpp"

namespace fast_edi {

Rosbag2Frames::Rosbag2Frames(const Rosbag2Streams& streams) : sources_(streams.sources) {}

std::string Rosbag2Frames::add(std::size_t source, std::int64_t stamp_ns, const RosImage& image,
                               std::optional<RecordedFrame>& complete) {
  Frame frame;
  std::swap(frame.pixels, spare_pixels_);
  std::string fault = packImage(image, frame.pixels);
  if (!fault.empty()) {
    return fault;
  }
  if (!isStamp(stamp_ns)) {
    return "a frame with a time before 1970 or after 2106";
  }
  frame.stamp_ns = stamp_ns;
  frame.size = sizeOf(image.width, image.height);
  frame.encoding = std::string(image.encoding);
  if (!hasExposures(sources_[source].stream)) {
    complete = give(std::move(frame), std::nullopt);
    return {};
  }
  const auto before = waiting_.find(source);
  if (before == waiting_.end()) {
    waiting_.emplace(source, std::move(frame));
  } else {
    complete = give(std::exchange(before->second, std::move(frame)), std::nullopt);
  }
  return {};
}

std::optional<RecordedFrame> Rosbag2Frames::addExposure(std::size_t stream,
                                                        std::int64_t exposure_us) {
  const auto frame = std::find_if(waiting_.begin(), waiting_.end(), [&](const auto& entry) {
    return sources_[entry.first].stream == stream;
  });
  if (frame == waiting_.end()) {
    return std::nullopt;  // of a frame that came before the recording began
  }
  Frame complete = std::move(frame->second);
  waiting_.erase(frame);
  return give(std::move(complete), exposure_us > 0
                                       ? std::optional(exposure_us * kNanosecondsPerMicrosecond)
                                       : std::nullopt);
}

std::optional<std::pair<std::size_t, RecordedFrame>> Rosbag2Frames::takeWaiting() {
  if (waiting_.empty()) {
    return std::nullopt;
  }
  const auto first = waiting_.begin();
  const std::size_t stream = sources_[first->first].stream;
  Frame frame = std::move(first->second);
  waiting_.erase(first);
  return std::pair{stream, give(std::move(frame), std::nullopt)};
}

bool Rosbag2Frames::hasExposures(std::size_t stream) const {
  return std::any_of(sources_.begin(), sources_.end(), [stream](const Rosbag2Source& source) {
    return source.kind == Rosbag2Kind::kExposure && source.stream == stream;
  });
}

RecordedFrame Rosbag2Frames::give(Frame frame, std::optional<std::int64_t> exposure_ns) {
  spare_pixels_ = std::move(given_.pixels);
  given_ = std::move(frame);
  RecordedFrame given;
  given.stamp_ns = given_.stamp_ns;
  if (exposure_ns) {
    // The driver's rule: see ExposureInterval::at().
    const std::int64_t half_us = *exposure_ns / 2 / kNanosecondsPerMicrosecond;
    const std::int64_t start_ns = given.stamp_ns - half_us * kNanosecondsPerMicrosecond;
    given.exposure = ExposureInterval{start_ns, start_ns + *exposure_ns};
  }
  given.size = given_.size;
  given.encoding = given_.encoding;
  given.pixels = given_.pixels.data();
  given.bytes = given_.pixels.size();
  return given;
}

}  // namespace fast_edi
