#include "recording/aedat4_packets.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "fast_edi/recording/aedat4_reader.hpp"
#include "recording/damage_notes.hpp"
#include "recording/number_at.hpp"
#include "recording/record_clock.hpp"

namespace fast_edi {
namespace {

/// How far a search for the next packet reads at once.
constexpr std::size_t kSearchBlockBytes = 1 << 20;
/// Places that look like a packet, behind damage: the first bytes of its data.
constexpr std::size_t kPacketStartBytes = 12;
constexpr std::uint32_t kLz4Magic = 0x184D2204;
constexpr std::uint32_t kZstdMagic = 0xFD2FB528;

/// When the packets of a stream end: as the file's table has it, but that no time goes back, and
/// none that is far ahead of all before it counts unless the next packet lies there, too.
void straightenEnds(std::vector<Aedat4TableEntry*>& packets) {
  constexpr std::int64_t kMaxStep_us = RecordClock::kMaxStep_ns / kNanosecondsPerMicrosecond;
  if (packets.size() > 1 && packets[0]->end_us > packets[1]->end_us + kMaxStep_us) {
    packets[0]->end_us = packets[1]->end_us;
  }
  for (std::size_t i = 1; i < packets.size(); ++i) {
    const std::int64_t before_us = packets[i - 1]->end_us;
    std::int64_t& end_us = packets[i]->end_us;
    const bool goes_back = i + 1 < packets.size() && packets[i + 1]->end_us < end_us - kMaxStep_us;
    if (end_us < before_us || (end_us > before_us + kMaxStep_us && goes_back)) {
      end_us = before_us;
    }
  }
}

/// Packets in the order of time, when the data table shows that all frames lie before or behind all
/// events; else none.
std::vector<Aedat4Packet> mergedOrder(std::vector<Aedat4TableEntry> entries,
                                      const std::map<std::int32_t, RecordedStream>& streams) {
  struct Range {
    std::uint64_t first = std::numeric_limits<std::uint64_t>::max();
    std::uint64_t last = 0;
    std::vector<Aedat4TableEntry*> packets;
  };
  std::map<std::int32_t, Range> ranges;
  for (Aedat4TableEntry& entry : entries) {
    Range& range = ranges[entry.stream];
    range.first = std::min(range.first, entry.offset);
    range.last = std::max(range.last, entry.offset);
    range.packets.push_back(&entry);
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
  std::vector<Aedat4Packet> packets;
  if (!apart) {
    return packets;
  }
  for (auto& [stream, range] : ranges) {
    straightenEnds(range.packets);
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

Aedat4Packets::Aedat4Packets(const ByteSource& file, const Aedat4Header& header,
                             std::vector<RecordingDamage>& damage)
    : file_(file),
      header_(header),
      damage_(damage),
      offset_(header.first_packet),
      end_(header.data_table.value_or(file.size())) {}

void Aedat4Packets::note(std::uint64_t offset, const std::string& what) {
  noteDamage(damage_, {offset, what});
}

void Aedat4Packets::readTable() {
  if (!header_.data_table) {
    return;
  }
  std::optional<std::vector<Aedat4TableEntry>> table =
      readAedat4Table(file_, header_, decompressor_);
  if (table) {
    merged_ = mergedOrder(std::move(*table), header_.streams);
  } else {
    note(*header_.data_table, "the data table cannot be read");
  }
}

void Aedat4Packets::rewind() {
  offset_ = header_.first_packet;
  merged_done_ = 0;
}

bool Aedat4Packets::looksLikePacket(const std::uint8_t* start, std::uint64_t room) const {
  const auto size = numberAt<std::uint32_t>(start + sizeof(std::int32_t));
  if (size == 0 || size > std::numeric_limits<std::int32_t>::max() || size > room ||
      header_.streams.count(numberAt<std::int32_t>(start)) == 0) {
    return false;
  }
  const auto first = numberAt<std::uint32_t>(start + kAedat4PacketHeaderBytes);
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

std::uint64_t Aedat4Packets::findPacket(std::uint64_t from) {
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

bool Aedat4Packets::next(Aedat4Packet& packet) {
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
    packet.stream = numberAt<std::int32_t>(bytes);
    const auto size = numberAt<std::int32_t>(bytes + sizeof(packet.stream));
    packet.offset = begin + kAedat4PacketHeaderBytes;
    const std::uint64_t room = end_ - packet.offset;
    const bool known = !known_streams_required_ || header_.streams.empty() ||
                       header_.streams.count(packet.stream) > 0;
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

std::string Aedat4Packets::expectedStreams() const {
  std::string text = "stream";
  for (const auto& entry : header_.streams) {
    text += " " + std::to_string(entry.first);
  }
  return text;
}

bool Aedat4Packets::load(const Aedat4Packet& packet) {
  const std::uint8_t* data = file_.read(packet.offset, packet.size, scratch_);
  if (data == nullptr) {
    note(packet.offset, "cannot be read");
    return false;
  }
  const std::string fault = decompressor_.run(header_.compression, data, packet.size,
                                              Aedat4Reader::kMaxPacketBytes, buffer_);
  if (!fault.empty()) {
    note(packet.offset, fault);
  }
  return !buffer_.empty();
}

}  // namespace fast_edi
