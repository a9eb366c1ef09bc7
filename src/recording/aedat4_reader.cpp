#include "fast_edi/recording/aedat4_reader.hpp"

#include <algorithm>
#include <cstring>
#include <limits>
#include <optional>
#include <utility>

#include "fast_edi/exposure/stamp_limits.hpp"
#include "fast_edi/recording/recording_error.hpp"
#include "recording/aedat4_header.hpp"
#include "recording/damage_notes.hpp"
#include "recording/flatbuffer.hpp"
#include "recording/packet_compression.hpp"

namespace fast_edi {
namespace {

constexpr double kGravity = 9.80665;  ///< m/s^2
constexpr double kRadiansPerDegree = 0.017453292519943295;

// Fields of a packet of events, IMU samples or triggers; an event is a struct.
constexpr int kElements = 0;
constexpr std::size_t kEventBytes = 16;
constexpr std::size_t kEventX = 8;
constexpr std::size_t kEventY = 10;
constexpr std::size_t kEventOn = 12;

// Fields of a frame.
constexpr int kFrameTime = 0;
constexpr int kFrameExposureStart = 3;
constexpr int kFrameExposureEnd = 4;
constexpr int kFrameFormat = 5;
constexpr int kFrameWidth = 6;
constexpr int kFrameHeight = 7;
constexpr int kFrameX = 8;
constexpr int kFrameY = 9;
constexpr int kFramePixels = 10;
constexpr int kFrameExposure = 11;

// Fields of an IMU sample: time, temperature, then both vectors.
constexpr int kSampleTime = 0;
constexpr int kSampleAcceleration = 2;
constexpr int kSampleAngularVelocity = 5;
constexpr int kTriggerTime = 0;
constexpr int kTriggerType = 1;

/// How far a search for the next packet reads at once.
constexpr std::size_t kSearchBlockBytes = 1 << 20;
/// Places that look like a packet, behind damage: the first bytes of its data.
constexpr std::size_t kPacketStartBytes = 12;
constexpr std::uint32_t kLz4Magic = 0x184D2204;
constexpr std::uint32_t kZstdMagic = 0xFD2FB528;
/// More notes than this say nothing new.
constexpr int kMaxSide_px = std::numeric_limits<std::int16_t>::max();

template <typename Number>
Number read(const std::uint8_t* bytes) {
  Number number;
  std::memcpy(&number, bytes, sizeof(number));
  return number;
}

/// Nothing for a time that no stamp can hold.
std::optional<std::int64_t> stampOf(std::int64_t t_us) {
  constexpr std::int64_t kLast_us = kLastStamp_ns / kNanosecondsPerMicrosecond;
  return t_us >= 0 && t_us <= kLast_us ? std::optional(t_us * kNanosecondsPerMicrosecond)
                                       : std::nullopt;
}

struct PixelLayout {
  const char* encoding;
  std::size_t bytes;
};

/// Frame formats are OpenCV's types.
std::optional<PixelLayout> layoutOf(int format) {
  switch (format) {
    case 0:
      return PixelLayout{"mono8", 1};
    case 2:
      return PixelLayout{"mono16", 2};
    case 16:
      return PixelLayout{"bgr8", 3};
    case 18:
      return PixelLayout{"bgr16", 6};
    case 24:
      return PixelLayout{"bgra8", 4};
    case 26:
      return PixelLayout{"bgra16", 8};
    default:
      return std::nullopt;
  }
}

struct Packet {
  std::uint64_t offset = 0;  ///< of its data in the file
  std::int32_t stream = 0;
  std::uint32_t size = 0;
};

/// Packets in the order of time, when the data table shows that all frames lie before or behind all
/// events; else none.
std::vector<Packet> mergedOrder(std::vector<Aedat4TableEntry> entries,
                                const std::map<std::int32_t, RecordedStream>& streams) {
  struct Range {
    std::uint64_t first = std::numeric_limits<std::uint64_t>::max();
    std::uint64_t last = 0;
    std::int64_t latest_us = std::numeric_limits<std::int64_t>::min();
  };
  std::map<std::int32_t, Range> ranges;
  for (Aedat4TableEntry& entry : entries) {
    Range& range = ranges[entry.stream];
    range.first = std::min(range.first, entry.offset);
    range.last = std::max(range.last, entry.offset);
    // Each stream keeps its order where its time goes back.
    range.latest_us = entry.end_us = std::max(range.latest_us, entry.end_us);
  }
  const auto is_of = [&streams](std::int32_t stream, StreamKind kind) {
    const auto found = streams.find(stream);
    return found != streams.end() && found->second.kind == kind;
  };
  bool apart = false;
  for (const auto& [events, of_events] : ranges) {
    for (const auto& [frames, of_frames] : ranges) {
      if (is_of(events, StreamKind::kEvents) && is_of(frames, StreamKind::kFrames)) {
        apart |= of_events.last < of_frames.first || of_frames.last < of_events.first;
      }
    }
  }
  std::vector<Packet> packets;
  if (!apart) {
    return packets;
  }
  std::stable_sort(entries.begin(), entries.end(), [](const auto& a, const auto& b) {
    return a.end_us != b.end_us ? a.end_us < b.end_us : a.offset < b.offset;
  });
  packets.reserve(entries.size());
  for (const Aedat4TableEntry& entry : entries) {
    packets.push_back({entry.offset, entry.stream, entry.size});
  }
  return packets;
}

}  // namespace

class Aedat4Reader::Impl {
 public:
  explicit Impl(const std::string& path) : file_(path), header_(readAedat4Header(file_, path)) {
    for (const std::string& fault : header_.faults) {
      note(sizeof(kMagic) - 1, fault);
    }
    offset_ = header_.first_packet;
    end_ = header_.data_table.value_or(file_.size());
    if (header_.streams.empty()) {
      findStreams();
    }
    if (header_.data_table) {
      std::optional<std::vector<Aedat4TableEntry>> table =
          readAedat4Table(file_, header_, decompressor_);
      if (table) {
        merged_ = mergedOrder(std::move(*table), header_.streams);
      } else {
        note(*header_.data_table, "the data table cannot be read");
      }
    }
    for (const auto& entry : header_.streams) {
      numbers_[entry.first] = streams_.size();
      streams_.push_back(entry.second);
    }
    sizeFromFirstFrame();
  }

  bool next(RecordingItem& item) {
    for (;;) {
      if (giveEvents(item) || giveOther(item)) {
        return true;
      }
      Packet packet;
      if (!nextPacket(packet)) {
        return false;
      }
      open(packet);
    }
  }

  std::string format() const { return std::string("AEDAT4, ") + toString(header_.compression); }
  const std::vector<RecordedStream>& streams() const { return streams_; }
  const std::vector<RecordingDamage>& damage() const { return damage_; }
  std::uint64_t position() const { return merged_.empty() ? offset_ : merged_done_; }
  std::uint64_t length() const {
    return merged_.empty() ? end_ : static_cast<std::uint64_t>(merged_.size());
  }
  std::uint64_t fileSize() const { return file_.size(); }
  std::optional<BiasConfiguration> biases() const { return header_.biases; }

 private:
  void note(std::uint64_t offset, const std::string& what) { noteDamage(damage_, {offset, what}); }

  /// Whether the bytes at \p start can be the begin of a packet that ends by \p room.
  bool looksLikePacket(const std::uint8_t* start, std::uint64_t room) const {
    const auto size = read<std::uint32_t>(start + sizeof(std::int32_t));
    if (size == 0 || size > std::numeric_limits<std::int32_t>::max() || size > room ||
        header_.streams.count(read<std::int32_t>(start)) == 0) {
      return false;
    }
    const auto first = read<std::uint32_t>(start + kAedat4PacketHeaderBytes);
    switch (header_.compression) {
      case Compression::kLz4:
        return first == kLz4Magic;
      case Compression::kZstd:
        return first == kZstdMagic;
      case Compression::kNone:
        break;
    }
    return first + sizeof(first) == size;  // the buffer's own size
  }

  /// The next place from \p from on that looks like a packet; end_ if there is none.
  std::uint64_t findPacket(std::uint64_t from) {
    while (from + kPacketStartBytes <= end_) {
      const auto count =
          static_cast<std::size_t>(std::min<std::uint64_t>(kSearchBlockBytes, end_ - from));
      const std::uint8_t* bytes = file_.read(from, count, scratch_);
      if (bytes == nullptr) {
        break;
      }
      for (std::size_t i = 0; i + kPacketStartBytes <= count; ++i) {
        if (looksLikePacket(bytes + i, end_ - from - i - kAedat4PacketHeaderBytes)) {
          return from + i;
        }
      }
      from += count - kPacketStartBytes + 1;
    }
    return end_;
  }

  bool nextPacket(Packet& packet) {
    if (!merged_.empty()) {
      if (merged_done_ == merged_.size()) {
        return false;
      }
      packet = merged_[merged_done_++];
      return true;
    }
    while (offset_ < end_) {
      const std::uint64_t begin = offset_;
      const std::uint8_t* bytes = file_.read(begin, kAedat4PacketHeaderBytes, scratch_);
      if (bytes == nullptr || begin + kAedat4PacketHeaderBytes > end_) {
        note(begin, std::to_string(end_ - begin) + " bytes at the end, expected a packet: cut");
        offset_ = end_;
        return false;
      }
      packet.stream = read<std::int32_t>(bytes);
      const auto size = read<std::int32_t>(bytes + sizeof(packet.stream));
      packet.offset = begin + kAedat4PacketHeaderBytes;
      const std::uint64_t room = end_ - packet.offset;
      const bool known = numbers_.empty() || numbers_.count(packet.stream) > 0;
      if (known && size > 0 && static_cast<std::uint64_t>(size) <= room) {
        packet.size = static_cast<std::uint32_t>(size);
        offset_ = packet.offset + packet.size;
        return true;
      }
      note(begin, "a packet of stream " + std::to_string(packet.stream) + " with " +
                      std::to_string(size) + " bytes, expected " + expectedStreams() + " and 1.." +
                      std::to_string(room) + " bytes");
      offset_ = findPacket(begin + 1);
      if (offset_ == end_ && known && size > 0) {
        packet.size = static_cast<std::uint32_t>(room);  // the last one, cut
        return room > 0;
      }
    }
    return false;
  }

  std::string expectedStreams() const {
    std::string text = "stream";
    for (const auto& entry : numbers_) {
      text += " " + std::to_string(entry.first);
    }
    return text;
  }

  /// Decompresses a packet into buffer_. \return false when nothing of it is left
  bool load(const Packet& packet) {
    const std::uint8_t* data = file_.read(packet.offset, packet.size, scratch_);
    if (data == nullptr) {
      note(packet.offset, "cannot be read");
      return false;
    }
    const std::string fault =
        decompressor_.run(header_.compression, data, packet.size, kMaxPacketBytes, buffer_);
    if (!fault.empty()) {
      note(packet.offset, fault);
    }
    return !buffer_.empty();
  }

  FlatBytes bytes() const { return {buffer_.data(), buffer_.size()}; }

  /// Without a description of the streams: by the identifiers of the first packets.
  void findStreams() {
    constexpr int kPacketsLookedAt = 64;
    const std::vector<RecordingDamage> before = damage_;
    Packet packet;
    for (int i = 0; i < kPacketsLookedAt && nextPacket(packet); ++i) {
      if (!load(packet)) {
        continue;
      }
      RecordedStream stream;
      if (FlatTable::root(bytes(), kAedat4Events)) {
        stream.kind = StreamKind::kEvents;
      } else if (FlatTable::root(bytes(), kAedat4Frames)) {
        stream.kind = StreamKind::kFrames;
      } else if (FlatTable::root(bytes(), kAedat4Imu)) {
        stream.kind = StreamKind::kImu;
      } else if (FlatTable::root(bytes(), kAedat4Triggers)) {
        stream.kind = StreamKind::kTriggers;
      } else {
        continue;
      }
      header_.streams.emplace(packet.stream, stream);
    }
    rewind(before);
  }

  /// Events of unknown size have that of the first frame.
  void sizeFromFirstFrame() {
    const bool missing = std::any_of(streams_.begin(), streams_.end(), [](const auto& stream) {
      return stream.kind == StreamKind::kEvents && stream.size.pixelCount() == 0;
    });
    if (!missing) {
      return;
    }
    const std::vector<RecordingDamage> before = damage_;
    Packet packet;
    SensorSize size;
    while (size.pixelCount() == 0 && nextPacket(packet)) {
      const auto number = numbers_.find(packet.stream);
      if (number == numbers_.end() || streams_[number->second].kind != StreamKind::kFrames ||
          !load(packet)) {
        continue;
      }
      if (const std::optional<FlatTable> frame = FlatTable::root(bytes(), kAedat4Frames)) {
        size = {std::max<int>(0, frame->number<std::int16_t>(kFrameWidth, 0)),
                std::max<int>(0, frame->number<std::int16_t>(kFrameHeight, 0))};
      }
    }
    for (RecordedStream& stream : streams_) {
      if (stream.kind == StreamKind::kEvents && stream.size.pixelCount() == 0) {
        stream.size = size;
      }
    }
    rewind(before);
  }

  void rewind(const std::vector<RecordingDamage>& damage) {
    damage_ = damage;
    offset_ = header_.first_packet;
    merged_done_ = 0;
  }

  void open(const Packet& packet) {
    table_.reset();
    elements_ = {};
    const auto number = numbers_.find(packet.stream);
    if (number == numbers_.end()) {
      note(packet.offset, "a packet of stream " + std::to_string(packet.stream) + ", expected " +
                              expectedStreams());
      return;
    }
    stream_ = number->second;
    if (!load(packet)) {
      return;
    }
    const char* identifier = kAedat4Events;
    switch (streams_[stream_].kind) {
      case StreamKind::kFrames:
        identifier = kAedat4Frames;
        break;
      case StreamKind::kImu:
        identifier = kAedat4Imu;
        break;
      case StreamKind::kTriggers:
        identifier = kAedat4Triggers;
        break;
      case StreamKind::kEvents:
      case StreamKind::kCalibration:
        break;
    }
    table_ = FlatTable::root(bytes(), identifier);
    if (!table_) {
      note(packet.offset, std::string("expected a packet with the identifier ") + identifier);
      return;
    }
    done_ = 0;
    packet_offset_ = packet.offset;
    const bool frame = streams_[stream_].kind == StreamKind::kFrames;
    const bool events = streams_[stream_].kind == StreamKind::kEvents;
    elements_ = frame ? FlatVector{nullptr, 1, true}
                      : table_->vector(kElements, events ? kEventBytes : sizeof(std::uint32_t));
    if (!elements_.complete) {
      note(packet.offset, "a packet that is shorter than it says: " +
                              std::to_string(elements_.count) + " elements are there");
    }
  }

  bool give(RecordingItem& item, std::int64_t record_ns) {
    record_ns_ = std::max(record_ns_, record_ns);
    item.stream = stream_;
    item.record_ns = record_ns_;
    return true;
  }

  bool giveEvents(RecordingItem& item) {
    while (table_ && streams_[stream_].kind == StreamKind::kEvents && done_ < elements_.count) {
      if (giveSomeEvents(item)) {
        return true;
      }
    }
    return false;
  }

  bool giveSomeEvents(RecordingItem& item) {
    const std::size_t end = std::min(elements_.count, done_ + kMaxItemEvents);
    events_.resize(end - done_);
    std::size_t count = 0;
    std::size_t untold = 0;
    for (; done_ < end; ++done_) {
      const std::uint8_t* element = elements_.data + done_ * kEventBytes;
      const std::optional<std::int64_t> t_ns = stampOf(read<std::int64_t>(element));
      if (!t_ns) {
        ++untold;
        continue;
      }
      // Negative coordinates become ones beyond any sensor, which the pipeline drops and counts.
      events_[count++] = {read<std::uint16_t>(element + kEventX),
                          read<std::uint16_t>(element + kEventY), *t_ns, element[kEventOn] != 0};
    }
    if (untold > 0) {
      note(packet_offset_, std::to_string(untold) + " events with times before 1970 or after 2106");
    }
    if (count == 0) {
      return false;
    }
    item.content = RecordedEvents{events_.data(), count};
    return give(item, events_[count - 1].t_ns);
  }

  bool giveOther(RecordingItem& item) {
    while (table_ && streams_[stream_].kind != StreamKind::kEvents && done_ < elements_.count) {
      const std::size_t index = done_++;
      const StreamKind kind = streams_[stream_].kind;
      if (kind == StreamKind::kFrames ? giveFrame(item) : giveElement(item, kind, index)) {
        return true;
      }
    }
    return false;
  }

  bool giveElement(RecordingItem& item, StreamKind kind, std::size_t index) {
    const std::optional<FlatTable> element = table_->element(kElements, index);
    const std::optional<std::int64_t> t_ns =
        element ? stampOf(element->number<std::int64_t>(kSampleTime, 0)) : std::nullopt;
    if (!t_ns) {
      note(packet_offset_, "element " + std::to_string(index) + " of a packet is damaged");
      return false;
    }
    if (kind == StreamKind::kTriggers) {
      static_assert(kTriggerTime == kSampleTime, "both are read above");
      item.content = RecordedTrigger{*t_ns, element->number<std::int8_t>(kTriggerType, 0)};
      return give(item, *t_ns);
    }
    RecordedImu sample;
    sample.t_ns = *t_ns;
    for (int axis = 0; axis < 3; ++axis) {
      const auto i = static_cast<std::size_t>(axis);
      sample.acceleration[i] =
          kGravity * static_cast<double>(element->number<float>(kSampleAcceleration + axis, 0.0F));
      sample.angular_velocity[i] = kRadiansPerDegree * static_cast<double>(element->number<float>(
                                                           kSampleAngularVelocity + axis, 0.0F));
    }
    item.content = sample;
    return give(item, *t_ns);
  }

  /// Exposure start and end; older writers leave one or both away.
  static std::optional<ExposureInterval> exposureOf(const FlatTable& table) {
    const auto start_us = table.number<std::int64_t>(kFrameExposureStart, 0);
    const auto end_us = table.number<std::int64_t>(kFrameExposureEnd, 0);
    const std::optional<std::int64_t> start = stampOf(start_us);
    const std::optional<std::int64_t> end = stampOf(end_us);
    if (start_us > 0 && start && end && *end > *start) {
      return ExposureInterval{*start, *end};
    }
    const std::optional<std::int64_t> begin =
        stampOf(start_us > 0 ? start_us : table.number<std::int64_t>(kFrameTime, 0));
    const std::optional<std::int64_t> length =
        stampOf(table.number<std::int64_t>(kFrameExposure, 0));
    if (begin && length && *length > 0 && *length <= kLastStamp_ns - *begin) {
      return ExposureInterval{*begin, *begin + *length};
    }
    return std::nullopt;
  }

  bool giveFrame(RecordingItem& item) {
    const FlatTable& table = *table_;
    const int width = table.number<std::int16_t>(kFrameWidth, 0);
    const int height = table.number<std::int16_t>(kFrameHeight, 0);
    const int format = table.number<std::uint8_t>(kFrameFormat, 0);
    const FlatVector pixels = table.vector(kFramePixels, 1);
    const std::optional<PixelLayout> layout = layoutOf(format);
    const std::optional<ExposureInterval> exposure = exposureOf(table);
    const std::optional<std::int64_t> stamp =
        exposure ? exposure->at(ExposureInstant::kMid)
                 : stampOf(table.number<std::int64_t>(kFrameTime, 0));
    const auto refuse = [this](const std::string& what) {
      note(packet_offset_, "a frame " + what + ": left out");
      return false;
    };
    if (!layout) {
      return refuse("of format " + std::to_string(format) +
                    ", expected 0, 16, 24 (8 bit), 2, 18 or 26 (16 bit)");
    }
    if (!stamp) {
      return refuse("with a time before 1970 or after 2106");
    }
    const std::size_t needed =
        width > 0 && height > 0
            ? static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * layout->bytes
            : 0;
    if (needed == 0 || pixels.count < needed) {
      return refuse("of " + std::to_string(width) + " x " + std::to_string(height) +
                    " pixels with " + std::to_string(pixels.count) + " bytes, expected " +
                    std::to_string(needed));
    }
    RecordedFrame frame;
    frame.exposure = exposure;
    frame.stamp_ns = *stamp;
    frame.size = {width, height};
    frame.encoding = layout->encoding;
    frame.pixels = pixels.data;
    frame.bytes = needed;
    place(frame, table.number<std::int16_t>(kFrameX, 0), table.number<std::int16_t>(kFrameY, 0),
          layout->bytes);
    item.content = frame;
    return give(item, exposure ? exposure->end_ns : *stamp);
  }

  /// Puts a frame of a part of the sensor where it belongs; the rest stays black.
  void place(RecordedFrame& frame, int left, int top, std::size_t pixel_bytes) {
    const SensorSize sensor = sensorOf(streams_[stream_]);
    if (frame.size == sensor || left < 0 || top < 0 || frame.size.width > sensor.width - left ||
        frame.size.height > sensor.height - top) {
      return;  // whole, or not within the sensor that the file tells of: as it is
    }
    const std::size_t row_bytes = static_cast<std::size_t>(frame.size.width) * pixel_bytes;
    canvas_.assign(sensor.pixelCount() * pixel_bytes, 0);
    for (int y = 0; y < frame.size.height; ++y) {
      const auto row = static_cast<std::size_t>(y);
      const std::size_t first =
          (row + static_cast<std::size_t>(top)) * static_cast<std::size_t>(sensor.width) +
          static_cast<std::size_t>(left);
      std::memcpy(canvas_.data() + first * pixel_bytes, frame.pixels + row * row_bytes, row_bytes);
    }
    frame.size = sensor;
    frame.pixels = canvas_.data();
    frame.bytes = canvas_.size();
  }

  /// The sensor that frames of \p frames come from: that of its camera's events.
  SensorSize sensorOf(const RecordedStream& frames) const {
    const auto events = std::find_if(streams_.begin(), streams_.end(), [&](const auto& stream) {
      return stream.kind == StreamKind::kEvents && stream.camera == frames.camera;
    });
    const SensorSize size = events != streams_.end() ? events->size : frames.size;
    return size.width <= kMaxSide_px && size.height <= kMaxSide_px ? size : SensorSize{};
  }

  FileSource file_;
  Aedat4Header header_;
  std::vector<RecordedStream> streams_;
  std::map<std::int32_t, std::size_t> numbers_;  ///< from the packets' numbers to streams_
  std::vector<RecordingDamage> damage_;
  Decompressor decompressor_;

  std::uint64_t offset_ = 0;  ///< of the next packet
  std::uint64_t end_ = 0;     ///< of the packets
  std::vector<Packet> merged_;
  std::size_t merged_done_ = 0;

  // The packet at hand.
  std::size_t stream_ = 0;
  std::uint64_t packet_offset_ = 0;
  std::vector<std::uint8_t> scratch_;
  std::vector<std::uint8_t> buffer_;
  std::optional<FlatTable> table_;
  FlatVector elements_;
  std::size_t done_ = 0;  ///< elements that were given
  std::vector<Event> events_;
  std::vector<std::uint8_t> canvas_;
  std::int64_t record_ns_ = 0;
};

Aedat4Reader::Aedat4Reader(const std::string& path) : impl_(std::make_unique<Impl>(path)) {}
Aedat4Reader::~Aedat4Reader() = default;

std::string Aedat4Reader::format() const {
  return impl_->format();
}
const std::vector<RecordedStream>& Aedat4Reader::streams() const {
  return impl_->streams();
}
bool Aedat4Reader::next(RecordingItem& item) {
  return impl_->next(item);
}
const std::vector<RecordingDamage>& Aedat4Reader::damage() const {
  return impl_->damage();
}
std::uint64_t Aedat4Reader::position() const {
  return impl_->position();
}
std::uint64_t Aedat4Reader::length() const {
  return impl_->length();
}
std::uint64_t Aedat4Reader::fileSize() const {
  return impl_->fileSize();
}
std::optional<BiasConfiguration> Aedat4Reader::biases() const {
  return impl_->biases();
}

}  // namespace fast_edi
