/// \file
/// What the messages of a rosbag2 belong to, and the sizes of its sensors.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <utility>

#include "fast_edi/recording/picture_decoder.hpp"
#include "recording/rosbag2_messages.hpp"
#include "recording/rosbag2_topics.hpp"

namespace fast_edi {

/// Finds the sources of messages; notes, once for each topic, what is left out.
class Rosbag2Sources {
 public:
  /// \param messages must outlive this, as must \p streams
  /// \param decodes whether compressed frames are decoded
  Rosbag2Sources(Rosbag2Messages& messages, const Rosbag2Streams& streams, bool decodes)
      : messages_(&messages), streams_(&streams), decodes_(decodes) {}

  /// Index into Rosbag2Streams::sources; nothing for messages that are not read.
  std::optional<std::size_t> find(const Rosbag2Message& message);

 private:
  std::optional<std::size_t> findTopic(const Rosbag2Message& message) const;

  Rosbag2Messages* messages_;
  const Rosbag2Streams* streams_;
  bool decodes_;
  /// By file and its number of the topic.
  std::map<std::pair<std::size_t, std::size_t>, std::optional<std::size_t>> found_;
};

/// Sets the sizes of \p streams by what the first message of events or frames says; of events that
/// have none, to the frames'. Rewind the messages afterwards.
void findSizes(Rosbag2Messages& messages, const PictureDecoder& decode, Rosbag2Sources& sources,
               Rosbag2Streams& streams);

}  // namespace fast_edi
