#include "fast_edi/recording/rosbag2_reader.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "fast_edi/exposure/stamp_limits.hpp"
#include "recording/cdr_messages.hpp"
#include "recording/event_array_decoder.hpp"
#include "recording/event_packet_decoder.hpp"
#include "recording/rosbag2_frames.hpp"
#include "recording/rosbag2_messages.hpp"
#include "recording/rosbag2_sources.hpp"
#include "recording/rosbag2_topics.hpp"

namespace fast_edi {
namespace {

class Rosbag2Reader : public Recording {
 public:
  Rosbag2Reader(const std::string& path, PictureDecoder decode)
      : decode_(std::move(decode)),
        messages_(path),
        streams_(streamsOf(messages_.topics())),
        packets_(streams_.sources.size()),
        frames_(streams_),
        sources_(messages_, streams_, decode_ != nullptr) {
    findSizes(messages_, decode_, sources_, streams_);
    sources_ = Rosbag2Sources(messages_, streams_, decode_ != nullptr);
    messages_.rewind();
  }

  bool next(RecordingItem& item) override {
    for (;;) {
      if (giveEvents(item)) {
        return true;
      }
      Rosbag2Message message;
      if (!messages_.next(message)) {
        return giveLastFrame(item);
      }
      if (take(message, item)) {
        return true;
      }
    }
  }

  std::string format() const override { return messages_.format(); }
  const std::vector<RecordedStream>& streams() const override { return streams_.streams; }
  const std::vector<RecordingDamage>& damage() const override { return messages_.damage(); }
  std::uint64_t position() const override { return messages_.position(); }
  std::uint64_t length() const override { return messages_.length(); }
  std::uint64_t fileSize() const override { return messages_.fileSize(); }

 private:
  /// What is kept of a topic of event packets from message to message.
  struct Packets {
    EventPacketDecoder decoder;
    std::optional<std::uint64_t> sequence;  ///< of the last one
    std::uint64_t lost = 0;                 ///< before the next events
  };

  bool take(Rosbag2Message message, RecordingItem& item) {
    const std::optional<std::size_t> source = sources_.find(message);
    if (!source || !messages_.uncompress(message)) {
      return false;
    }
    if (isStamp(message.record_ns)) {
      record_ns_ = std::max(record_ns_, message.record_ns);
    } else {
      messages_.note(message, "recorded before 1970 or after 2106");
    }
    const Rosbag2Source& of = streams_.sources[*source];
    item.stream = of.stream;
    item.record_ns = record_ns_;
    CdrReader cdr(message.data, message.size);
    switch (of.kind) {
      case Rosbag2Kind::kEventArray:
        beginArray(*source, message, cdr);
        return false;
      case Rosbag2Kind::kEventPacket:
        beginPacket(*source, message, cdr);
        return false;
      case Rosbag2Kind::kImage:
        return takeImage(*source, message, cdr, item);
      case Rosbag2Kind::kCompressedImage:
        return takeCompressed(*source, message, cdr, item);
      case Rosbag2Kind::kImu:
        return takeWhole<RecordedImu>(message, cdr, readImu, item);
      case Rosbag2Kind::kCalibration:
        return takeWhole<RecordedCalibration>(message, cdr, readCalibration, item);
      case Rosbag2Kind::kExposure:
        break;
    }
    return takeExposure(message, cdr, item);
  }

  bool refuse(const Rosbag2Message& message, const std::string& what) {
    messages_.note(message, what + ": left out");
    return false;
  }
  bool refuseCut(const Rosbag2Message& message) {
    return refuse(message, "a message of " + std::to_string(message.size) +
                               " bytes that ends within its fields");
  }

  void beginArray(std::size_t source, const Rosbag2Message& message, CdrReader& cdr) {
    readHeader(cdr);
    cdr.number<std::uint32_t>();  // height
    cdr.number<std::uint32_t>();  // width
    const auto count = cdr.number<std::uint32_t>();
    if (!cdr.ok()) {
      refuseCut(message);
      return;
    }
    array_.begin(cdr, count);
    if (array_.left() < count) {
      messages_.note(message, "an array of " + std::to_string(count) + " events, " +
                                  std::to_string(array_.left()) + " of which are there");
    }
    startEvents(source, message);
  }

  void beginPacket(std::size_t source, const Rosbag2Message& message, CdrReader& cdr) {
    Packets& packets = packets_[source];
    EventPacket packet;
    packet.stamp_ns = readHeader(cdr);
    cdr.number<std::uint32_t>();  // height
    cdr.number<std::uint32_t>();  // width
    const auto sequence = cdr.number<std::uint64_t>();
    packet.time_base_ns = cdr.number<std::uint64_t>();
    packet.encoding = cdr.text();
    packet.big_endian = cdr.number<std::uint8_t>() != 0;
    const CdrBytes bytes = cdr.availableBytes();
    if (bytes.data == nullptr) {
      refuseCut(message);
      return;
    }
    if (!cdr.ok()) {
      messages_.note(message, "a packet of events that is cut: " + std::to_string(bytes.size) +
                                  " bytes are there");
    }
    packet.data = bytes.data;
    packet.size = bytes.size;
    const std::string fault = packets.decoder.begin(packet);
    if (!fault.empty()) {
      messages_.note(message, fault);
    }
    if (packets.sequence && sequence > *packets.sequence + 1) {
      const std::uint64_t lost = sequence - *packets.sequence - 1;
      messages_.note(message, std::to_string(lost) +
                                  " packets of events were lost before this one, when " +
                                  "they were recorded");
      packets.lost += lost;
    }
    packets.sequence = sequence;
    startEvents(source, message);
  }

  void startEvents(std::size_t source, const Rosbag2Message& message) {
    events_source_ = source;
    events_message_ = message;
  }

  bool giveEvents(RecordingItem& item) {
    while (events_source_) {
      const Rosbag2Source& source = streams_.sources[*events_source_];
      Packets& packets = packets_[*events_source_];
      events_.clear();
      const bool is_packet = source.kind == Rosbag2Kind::kEventPacket;
      const bool more = is_packet ? packets.decoder.decode(events_, kMaxItemEvents)
                                  : array_.decode(events_, kMaxItemEvents);
      if (!more) {
        finishEvents(is_packet ? packets.decoder.untold() : array_.untold(),
                     is_packet ? packets.decoder.unknownWords() : 0);
      }
      if (events_.empty()) {
        continue;
      }
      RecordedEvents given{events_.data(), events_.size()};
      given.lost_arrays = static_cast<std::uint32_t>(
          std::min<std::uint64_t>(packets.lost, std::numeric_limits<std::uint16_t>::max()));
      packets.lost = 0;
      item.stream = source.stream;
      item.record_ns = record_ns_;
      item.content = given;
      return true;
    }
    return false;
  }

  void finishEvents(std::size_t untold, std::size_t unknown_words) {
    events_source_.reset();
    if (untold > 0) {
      messages_.note(events_message_,
                     std::to_string(untold) + " events with times before 1970 or after 2106");
    }
    if (unknown_words > 0) {
      messages_.note(events_message_, std::to_string(unknown_words) +
                                          " words with a code that the encoding does not have");
    }
  }

  bool takeImage(std::size_t source, const Rosbag2Message& message, CdrReader& cdr,
                 RecordingItem& item) {
    RosImage image;
    const std::int64_t stamp_ns = readImage(cdr, image);
    if (!cdr.ok()) {
      return refuseCut(message);
    }
    return addFrame(source, message, stamp_ns, image, item);
  }

  bool takeCompressed(std::size_t source, const Rosbag2Message& message, CdrReader& cdr,
                      RecordingItem& item) {
    CompressedPicture compressed;
    const std::int64_t stamp_ns = readCompressedImage(cdr, compressed);
    if (!cdr.ok()) {
      return refuseCut(message);
    }
    Picture picture;
    const std::string fault = decode_(compressed, picture);
    if (!fault.empty()) {
      return refuse(message, fault);
    }
    RosImage image;
    image.width = static_cast<std::uint32_t>(picture.size.width);
    image.height = static_cast<std::uint32_t>(picture.size.height);
    image.encoding = picture.encoding;
    image.data = picture.pixels.data();
    image.bytes = picture.pixels.size();
    image.step = static_cast<std::uint32_t>(image.bytes / image.height);
    return addFrame(source, message, stamp_ns, image, item);
  }

  bool addFrame(std::size_t source, const Rosbag2Message& message, std::int64_t stamp_ns,
                const RosImage& image, RecordingItem& item) {
    std::optional<RecordedFrame> complete;
    const std::string fault = frames_.add(source, stamp_ns, image, complete);
    return fault.empty() ? give(complete, item) : refuse(message, fault);
  }

  bool takeExposure(const Rosbag2Message& message, CdrReader& cdr, RecordingItem& item) {
    const std::int64_t exposure_us = cdr.number<std::int32_t>();
    return cdr.ok() ? give(frames_.addExposure(item.stream, exposure_us), item)
                    : refuseCut(message);
  }

  static bool give(const std::optional<RecordedFrame>& frame, RecordingItem& item) {
    if (frame) {
      item.content = *frame;
    }
    return frame.has_value();
  }

  bool giveLastFrame(RecordingItem& item) {
    const auto frame = frames_.takeWaiting();
    if (!frame) {
      return false;
    }
    item.stream = frame->first;
    item.record_ns = record_ns_;
    item.content = frame->second;
    return true;
  }

  /// A message that is an item by itself.
  template <typename Content, typename Read>
  bool takeWhole(const Rosbag2Message& message, CdrReader& cdr, Read read, RecordingItem& item) {
    Content content;
    const std::string fault = read(cdr, content);
    if (!cdr.ok()) {
      return refuseCut(message);
    }
    if (!fault.empty()) {
      return refuse(message, fault);
    }
    item.content = std::move(content);
    return true;
  }

  const PictureDecoder decode_;  ///< may be empty
  Rosbag2Messages messages_;
  Rosbag2Streams streams_;
  std::vector<Packets> packets_;  ///< of each source
  Rosbag2Frames frames_;
  Rosbag2Sources sources_;
  std::int64_t record_ns_ = 0;

  /// Whose events are being decoded; nothing: none.
  std::optional<std::size_t> events_source_;
  Rosbag2Message events_message_;
  EventArrayDecoder array_;
  std::vector<Event> events_;
};

}  // namespace

std::unique_ptr<Recording> openRosbag2(const std::string& path, PictureDecoder decode) {
  return std::make_unique<Rosbag2Reader>(path, std::move(decode));
}

}  // namespace fast_edi
