#include "fast_edi/recording/aedat4_reader.hpp"

#include <algorithm>
#include <map>
#include <optional>

#include "recording/aedat4_frame_decoder.hpp"
#include "recording/aedat4_header.hpp"
#include "recording/aedat4_packet_decoder.hpp"
#include "recording/aedat4_packets.hpp"
#include "recording/damage_notes.hpp"
#include "recording/flatbuffer.hpp"

namespace fast_edi {

class Aedat4Reader::Impl {
 public:
  explicit Impl(const std::string& path)
      : file_(path),
        header_(readAedat4Header(file_, path)),
        packets_(file_, header_, damage_),
        decoder_(streams_, damage_) {
    for (const std::string& fault : header_.faults) {
      noteDamage(damage_, {sizeof(kMagic) - 1, fault});
    }
    if (header_.streams.empty()) {
      findStreams();
    }
    packets_.requireKnownStreams();
    packets_.readTable();
    for (const auto& entry : header_.streams) {
      numbers_[entry.first] = streams_.size();
      streams_.push_back(entry.second);
    }
    sizeFromFirstFrame();
  }

  bool next(RecordingItem& item) {
    while (!decoder_.next(item)) {
      Aedat4Packet packet;
      if (!packets_.next(packet)) {
        return false;
      }
      open(packet);
    }
    return true;
  }

  std::string format() const { return std::string("AEDAT4, ") + toString(header_.compression); }
  const std::vector<RecordedStream>& streams() const { return streams_; }
  const std::vector<RecordingDamage>& damage() const { return damage_; }
  std::uint64_t position() const { return packets_.position(); }
  std::uint64_t length() const { return packets_.length(); }
  std::uint64_t fileSize() const { return file_.size(); }
  std::optional<BiasConfiguration> biases() const { return header_.biases; }

 private:
  /// Without a description of the streams: by the identifiers of the first packets.
  void findStreams() {
    constexpr int kPacketsLookedAt = 64;
    const std::vector<RecordingDamage> before = damage_;
    Aedat4Packet packet;
    for (int i = 0; i < kPacketsLookedAt && packets_.next(packet); ++i) {
      if (!packets_.load(packet)) {
        continue;
      }
      RecordedStream stream;
      if (FlatTable::root(packets_.bytes(), kAedat4Events)) {
        stream.kind = StreamKind::kEvents;
      } else if (FlatTable::root(packets_.bytes(), kAedat4Frames)) {
        stream.kind = StreamKind::kFrames;
      } else if (FlatTable::root(packets_.bytes(), kAedat4Imu)) {
        stream.kind = StreamKind::kImu;
      } else if (FlatTable::root(packets_.bytes(), kAedat4Triggers)) {
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
    Aedat4Packet packet;
    SensorSize size;
    while (size.pixelCount() == 0 && packets_.next(packet)) {
      const auto number = numbers_.find(packet.stream);
      if (number == numbers_.end() || streams_[number->second].kind != StreamKind::kFrames ||
          !packets_.load(packet)) {
        continue;
      }
      if (const std::optional<FlatTable> frame = FlatTable::root(packets_.bytes(), kAedat4Frames)) {
        size = Aedat4FrameDecoder::sizeOf(*frame);
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
    packets_.rewind();
  }

  void open(const Aedat4Packet& packet) {
    const auto number = numbers_.find(packet.stream);
    if (number == numbers_.end()) {
      noteDamage(damage_, {packet.offset, "a packet of stream " + std::to_string(packet.stream) +
                                              ", expected " + packets_.expectedStreams()});
      return;
    }
    if (packets_.load(packet)) {
      decoder_.open(packets_.bytes(), number->second, packet.offset);
    }
  }

  FileSource file_;
  Aedat4Header header_;
  std::vector<RecordedStream> streams_;
  std::map<std::int32_t, std::size_t> numbers_;  ///< from the packets' numbers to streams_
  std::vector<RecordingDamage> damage_;
  Aedat4Packets packets_;
  Aedat4PacketDecoder decoder_;
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
