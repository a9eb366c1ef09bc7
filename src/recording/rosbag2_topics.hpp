/// \file
/// Which topics of a rosbag2 are read, and as which streams.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "fast_edi/recording/recording.hpp"
#include "recording/rosbag2_storage.hpp"

namespace fast_edi {

/// What messages of a topic are.
enum class Rosbag2Kind {
  kEventArray,
  kEventPacket,
  kImage,
  kCompressedImage,
  kImu,
  kCalibration,
  kExposure
};

struct Rosbag2Source {
  Rosbag2Kind kind = Rosbag2Kind::kEventArray;
  std::string topic;
  std::size_t stream = 0;  ///< of an exposure: that of its frames
};

/// Topics by what they are, and the streams that they become.
struct Rosbag2Streams {
  std::vector<Rosbag2Source> sources;
  std::vector<RecordedStream> streams;

  /// Index into sources; nothing for a topic that is not read.
  std::optional<std::size_t> find(const Rosbag2Topic& topic) const;
};

/// Nothing for types that are not read.
std::optional<Rosbag2Kind> kindOf(const std::string& type);

/// Compressed frames are read from TOPIC/compressed where TOPIC was not recorded, too; they belong
/// to the stream that TOPIC would be.
Rosbag2Streams streamsOf(const std::vector<Rosbag2Topic>& topics);

}  // namespace fast_edi
