/// \file
/// Frames of a rosbag2 with their exposures, which come in a message of another topic behind each
/// frame.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "fast_edi/recording/recording.hpp"
#include "recording/ros_image.hpp"
#include "recording/rosbag2_topics.hpp"

namespace fast_edi {

/// What is returned refers to memory of this object, until the next call.
class Rosbag2Frames {
 public:
  explicit Rosbag2Frames(const Rosbag2Streams& streams);

  /// Takes in a frame and copies its pixels.
  /// \param source index into Rosbag2Streams::sources
  /// \param complete the next complete frame of the source, if there is one: this one if no
  ///        exposures are recorded, or the one before it if it was still waiting for its exposure
  /// \return what is wrong with the frame, which is then left out; empty if nothing is
  std::string add(std::size_t source, std::int64_t stamp_ns, const RosImage& image,
                  std::optional<RecordedFrame>& complete);
  /// The frame of a stream that waits for this exposure, if one does.
  std::optional<RecordedFrame> addExposure(std::size_t stream, std::int64_t exposure_us);
  /// At the end: a frame whose exposure did not come, with its stream.
  std::optional<std::pair<std::size_t, RecordedFrame>> takeWaiting();

 private:
  struct Frame {
    std::int64_t stamp_ns = 0;
    SensorSize size;
    std::string encoding;
    std::vector<std::uint8_t> pixels;
  };

  bool hasExposures(std::size_t stream) const;
  RecordedFrame give(Frame frame, std::optional<std::int64_t> exposure_ns);

  const std::vector<Rosbag2Source> sources_;
  std::map<std::size_t, Frame> waiting_;  ///< for its exposure; by source
  Frame given_;                           ///< the last that was returned
  std::vector<std::uint8_t> spare_pixels_;
};

}  // namespace fast_edi
