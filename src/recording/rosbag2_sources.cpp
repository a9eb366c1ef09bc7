#include "recording/rosbag2_sources.hpp"

#include <algorithm>

#include "recording/cdr_messages.hpp"

namespace fast_edi {
namespace {

constexpr char kFormatOfMessages[] = "cdr";
/// Messages that are looked at for the size of the sensor.
constexpr int kMessagesLookedAt = 1000;

bool hasSize(const RecordedStream& stream) {
  return stream.kind == StreamKind::kEvents || stream.kind == StreamKind::kFrames;
}

SensorSize statedSize(Rosbag2Kind kind, const Rosbag2Message& message,
                      const PictureDecoder& decode) {
  CdrReader cdr(message.data, message.size);
  if (kind == Rosbag2Kind::kCompressedImage) {
    CompressedPicture compressed;
    readCompressedImage(cdr, compressed);
    Picture picture;
    return cdr.ok() && decode(compressed, picture).empty() ? picture.size : SensorSize{};
  }
  readHeader(cdr);
  const auto height = cdr.number<std::uint32_t>();
  const auto width = cdr.number<std::uint32_t>();
  return sizeOf(width, height);
}

}  // namespace

std::optional<std::size_t> Rosbag2Sources::find(const Rosbag2Message& message) {
  const std::pair place{messages_->file(), message.topic};
  const auto known = found_.find(place);
  return known != found_.end() ? known->second
                               : found_.emplace(place, findTopic(message)).first->second;
}

std::optional<std::size_t> Rosbag2Sources::findTopic(const Rosbag2Message& message) const {
  const Rosbag2Topic& topic = messages_->topicOf(message);
  const std::optional<Rosbag2Kind> kind = kindOf(topic.type);
  const std::optional<std::size_t> source = streams_->find(topic);
  if (!source) {
    // Exposures without frames, and compressed frames that are there raw, are left out on purpose.
    if (kind && *kind != Rosbag2Kind::kExposure && *kind != Rosbag2Kind::kCompressedImage) {
      messages_->note(message,
                      "a topic that neither metadata.yaml nor the files' heads tell of: left out");
    }
    return std::nullopt;
  }
  if (topic.format != kFormatOfMessages) {
    messages_->note(message,
                    "messages in the format \"" + topic.format + "\", expected cdr: left out");
    return std::nullopt;
  }
  if (kind == Rosbag2Kind::kCompressedImage && !decodes_) {
    messages_->note(message, "frames in PNG or JPEG, which are not decoded here: left out");
    return std::nullopt;
  }
  return source;
}

void findSizes(Rosbag2Messages& messages, const PictureDecoder& decode, Rosbag2Sources& sources,
               Rosbag2Streams& streams) {
  const auto is_missing = [&streams] {
    return std::any_of(streams.streams.begin(), streams.streams.end(), [](const auto& stream) {
      return hasSize(stream) && stream.size.pixelCount() == 0;
    });
  };
  Rosbag2Message message;
  for (int i = 0; i < kMessagesLookedAt && is_missing() && messages.peek(message); ++i) {
    const std::optional<std::size_t> source = sources.find(message);
    if (!source || !messages.uncompress(message)) {
      continue;
    }
    const Rosbag2Source& of = streams.sources[*source];
    RecordedStream& stream = streams.streams[of.stream];
    if (hasSize(stream) && of.kind != Rosbag2Kind::kExposure && stream.size.pixelCount() == 0) {
      stream.size = statedSize(of.kind, message, decode);
    }
  }
  for (RecordedStream& stream : streams.streams) {
    const auto frames = std::find_if(
        streams.streams.begin(), streams.streams.end(), [&](const RecordedStream& other) {
          return other.kind == StreamKind::kFrames && other.camera == stream.camera;
        });
    if (stream.kind == StreamKind::kEvents && stream.size.pixelCount() == 0 &&
        frames != streams.streams.end()) {
      stream.size = frames->size;
    }
  }
}

}  // namespace fast_edi
