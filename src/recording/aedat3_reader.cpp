#include "fast_edi/recording/aedat3_reader.hpp"

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "fast_edi/exposure/stamp_limits.hpp"
#include "fast_edi/recording/byte_source.hpp"
#include "fast_edi/recording/recording_error.hpp"
#include "recording/damage_notes.hpp"
#include "recording/davis_geometry.hpp"
#include "recording/imu_units.hpp"
#include "recording/number_at.hpp"
#include "recording/text_header.hpp"

namespace fast_edi {
namespace {

constexpr std::string_view kHeaderEnd = "#!END-HEADER";

// Kinds of packets.
constexpr std::int16_t kPolarityPacket = 1;
constexpr std::int16_t kFramePacket = 2;
constexpr std::int16_t kImuPacket = 3;
constexpr std::int16_t kLastKind = 100;

constexpr std::size_t kPacketHeaderBytes = 28;
constexpr std::size_t kPolarityBytes = 8;
constexpr std::size_t kFrameHeaderBytes = 36;
constexpr std::size_t kImuBytes = 36;
/// DAVIS346 with four channels; no frame is larger.
constexpr std::size_t kMaxFrameBytes = kFrameHeaderBytes + std::size_t{346} * 260 * 4 * 2;

constexpr std::uint32_t kValid = 1;
constexpr int kOverflowShift = 31;  ///< times have 31 bits
/// One more than what a ROS time (32 bits of seconds) can hold; their nanoseconds fit into 64 bits.
constexpr std::int64_t kMaxOverflows = std::int64_t{1} << 21;

struct PacketHeader {
  std::int16_t kind = 0;
  std::int64_t event_bytes = 0;
  std::int64_t overflow = 0;
  std::int64_t events = 0;

  static PacketHeader at(const std::uint8_t* data) {
    PacketHeader header;
    header.kind = numberAt<std::int16_t>(data);
    header.event_bytes = numberAt<std::int32_t>(data + 4);
    header.overflow = numberAt<std::int32_t>(data + 12);
    header.events = numberAt<std::int32_t>(data + 20);
    return header;
  }
  bool sound() const {
    return kind >= 0 && kind <= kLastKind && event_bytes > 0 && overflow >= 0 && events >= 0 &&
           leastBytes() <= event_bytes;
  }
  std::int64_t leastBytes() const {
    switch (kind) {
      case kPolarityPacket:
        return kPolarityBytes;
      case kFramePacket:
        return kFrameHeaderBytes;
      case kImuPacket:
        return kImuBytes;
      default:
        return 1;
    }
  }
};

class Aedat3Reader : public Recording {
 public:
  explicit Aedat3Reader(const std::string& path) : file_(path) {
    const std::string camera = readHeader(path);
    streams_ = davisStreams(path, camera, "#Source 1: ...");
    size_ = streams_[kDavisEvents].size;
  }

  bool next(RecordingItem& item) override {
    for (;;) {
      if (left_ == 0 && !openPacket()) {
        return false;
      }
      if (left_ > 0 && readEvents(item)) {
        return true;
      }
    }
  }

  std::string format() const override { return "AEDAT3.1"; }
  const std::vector<RecordedStream>& streams() const override { return streams_; }
  const std::vector<RecordingDamage>& damage() const override { return damage_; }
  std::uint64_t position() const override { return offset_; }
  std::uint64_t length() const override { return file_.size(); }
  std::uint64_t fileSize() const override { return file_.size(); }
  bool knowsExposures() const override { return true; }

 private:
  void note(std::uint64_t offset, const std::string& what) { noteDamage(damage_, {offset, what}); }

  /// \return the camera that it names
  std::string readHeader(const std::string& path) {
    std::vector<std::uint8_t> scratch;
    std::string_view text = textHeader(file_, scratch);
    std::string camera;
    while (!text.empty() && text[0] == '#') {
      const std::size_t end = text.find('\n');
      if (end == std::string_view::npos) {
        break;
      }
      const std::string_view line = text.substr(0, text.find_first_of("\r\n"));
      text.remove_prefix(end + 1);
      offset_ += end + 1;
      if (line.substr(0, kHeaderEnd.size()) == kHeaderEnd) {
        return camera;
      }
      const std::size_t colon = line.find(": ");
      if (camera.empty() && line.substr(0, 8) == "#Source " && colon != std::string_view::npos) {
        camera = std::string(line.substr(colon + 2));
      }
    }
    throw RecordingError(path + ", byte " + std::to_string(offset_) +
                         ": expected lines beginning with # up to #!END-HEADER");
  }

  /// \return false at the end
  bool openPacket() {
    const std::uint64_t left = file_.size() - offset_;
    if (left < kPacketHeaderBytes) {
      if (left > 0 && !ended_) {
        note(offset_, "a packet's header of " + std::to_string(left) +
                          " bytes, expected 28: the file is cut");
      }
      ended_ = true;
      return false;
    }
    const std::uint8_t* data = file_.read(offset_, kPacketHeaderBytes, scratch_);
    if (data == nullptr) {
      return false;
    }
    packet_ = PacketHeader::at(data);
    if (!packet_.sound()) {
      note(offset_, "a packet of kind " + std::to_string(packet_.kind) + " with " +
                        std::to_string(packet_.events) + " events of " +
                        std::to_string(packet_.event_bytes) +
                        " bytes, expected one that is possible: the rest is left out");
      offset_ = file_.size();
      ended_ = true;
      return false;
    }
    offset_ += kPacketHeaderBytes;
    left_ = packet_.events;
    const auto bytes = static_cast<std::uint64_t>(packet_.events) *
                       static_cast<std::uint64_t>(packet_.event_bytes);
    if (bytes > file_.size() - offset_) {
      note(offset_, "a packet of " + std::to_string(bytes) + " bytes, of which " +
                        std::to_string(file_.size() - offset_) + " are there");
      left_ = static_cast<std::int64_t>((file_.size() - offset_) /
                                        static_cast<std::uint64_t>(packet_.event_bytes));
      if (left_ == 0) {
        offset_ = file_.size();
      }
    }
    const bool known = packet_.kind == kPolarityPacket || packet_.kind == kFramePacket ||
                       packet_.kind == kImuPacket;
    if (!known) {
      skip(left_);
    }
    return true;
  }

  void skip(std::int64_t events) {
    offset_ += static_cast<std::uint64_t>(events) * static_cast<std::uint64_t>(packet_.event_bytes);
    left_ -= events;
  }

  /// Times of a packet's events; nothing for one that no stamp can hold.
  std::optional<std::int64_t> stampOf(const std::uint8_t* data) const {
    const auto t_us = numberAt<std::int32_t>(data);
    // A larger count of overflows is no time of a camera, and its nanoseconds would not fit.
    if (t_us < 0 || packet_.overflow >= kMaxOverflows) {
      return std::nullopt;
    }
    const std::int64_t t_ns =
        ((packet_.overflow << kOverflowShift) + t_us) * kNanosecondsPerMicrosecond;
    return isStamp(t_ns) ? std::optional(t_ns) : std::nullopt;
  }

  /// \return whether \p item holds something
  bool readEvents(RecordingItem& item) {
    if (packet_.kind == kPolarityPacket && packet_.event_bytes == kPolarityBytes) {
      return readPolarities(item);
    }
    const auto bytes = static_cast<std::size_t>(
        std::min<std::int64_t>(packet_.event_bytes, static_cast<std::int64_t>(kMaxFrameBytes)));
    const std::uint64_t offset = offset_;
    const std::uint8_t* data = file_.read(offset, bytes, scratch_);
    skip(1);
    if (data == nullptr || (numberAt<std::uint32_t>(data) & kValid) == 0) {
      return false;
    }
    if (packet_.kind == kFramePacket) {
      return giveFrame(data, bytes, offset, item);
    }
    return packet_.kind == kImuPacket && giveImu(data, offset, item);
  }

  bool readPolarities(RecordingItem& item) {
    const std::int64_t count =
        std::min<std::int64_t>(left_, static_cast<std::int64_t>(kMaxItemEvents));
    const std::uint64_t offset = offset_;
    const std::uint8_t* data =
        file_.read(offset, static_cast<std::size_t>(count) * kPolarityBytes, scratch_);
    skip(count);
    events_.clear();
    for (std::int64_t i = 0; data != nullptr && i < count; ++i, data += kPolarityBytes) {
      const auto word = numberAt<std::uint32_t>(data);
      if ((word & kValid) == 0) {
        continue;
      }
      const std::uint32_t x = word >> 17 & 0x7fff;
      const std::uint32_t y = word >> 2 & 0x7fff;
      const std::optional<std::int64_t> t_ns = stampOf(data + 4);
      if (!t_ns || x >= static_cast<std::uint32_t>(size_.width) ||
          y >= static_cast<std::uint32_t>(size_.height)) {
        note(offset + static_cast<std::uint64_t>(i) * kPolarityBytes,
             "an event at " + std::to_string(x) + ", " + std::to_string(y) +
                 ", expected one within " + std::to_string(size_.width) + "x" +
                 std::to_string(size_.height) + " and a time from 0 to 2^32 s");
        continue;
      }
      record_ns_ = std::max(record_ns_, *t_ns);
      events_.push_back(
          {static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y), *t_ns, (word & 2) != 0});
    }
    item.stream = kDavisEvents;
    item.record_ns = record_ns_;
    item.content = RecordedEvents{events_.data(), events_.size()};
    return !events_.empty();
  }

  bool giveFrame(const std::uint8_t* data, std::size_t bytes, std::uint64_t offset,
                 RecordingItem& item) {
    const std::optional<std::int64_t> frame_end = stampOf(data + 8);
    const std::optional<std::int64_t> start = stampOf(data + 12);
    const std::optional<std::int64_t> end = stampOf(data + 16);
    const auto width = numberAt<std::int32_t>(data + 20);
    const auto height = numberAt<std::int32_t>(data + 24);
    const std::uint32_t channels = numberAt<std::uint32_t>(data) >> 1 & 7;
    const char* const encoding = channels == 1   ? "mono16"
                                 : channels == 3 ? "rgb16"
                                 : channels == 4 ? "rgba16"
                                                 : nullptr;
    const bool sized = width > 0 && height > 0 && width <= size_.width && height <= size_.height;
    const std::size_t pixel_bytes =
        sized ? SensorSize{width, height}.pixelCount() * channels * sizeof(std::uint16_t) : 0;
    if (!start || !end || *end <= *start || encoding == nullptr || !sized ||
        pixel_bytes > bytes - kFrameHeaderBytes) {
      note(offset, "a frame of " + std::to_string(width) + "x" + std::to_string(height) + " with " +
                       std::to_string(channels) +
                       " channels, expected one within the sensor, of 1, 3 or 4 channels, whose "
                       "exposure ends after its start");
      return false;
    }
    pixels_.assign(data + kFrameHeaderBytes, data + kFrameHeaderBytes + pixel_bytes);
    RecordedFrame frame;
    frame.exposure = ExposureInterval{*start, *end};
    frame.stamp_ns = frame.exposure->at(ExposureInstant::kMid);
    frame.size = {width, height};
    frame.encoding = encoding;
    frame.pixels = pixels_.data();
    frame.bytes = pixels_.size();
    record_ns_ = std::max({record_ns_, *end, frame_end.value_or(0)});
    item.stream = kDavisFrames;
    item.record_ns = record_ns_;
    item.content = frame;
    return true;
  }

  bool giveImu(const std::uint8_t* data, std::uint64_t offset, RecordingItem& item) {
    const std::optional<std::int64_t> t_ns = stampOf(data + 4);
    if (!t_ns) {
      note(offset, "an IMU sample with a negative time");
      return false;
    }
    RecordedImu sample;
    sample.t_ns = *t_ns;
    for (std::size_t i = 0; i < 3; ++i) {
      sample.acceleration[i] = numberAt<float>(data + 8 + 4 * i) * kStandardGravity;
      sample.angular_velocity[i] = numberAt<float>(data + 20 + 4 * i) * kRadiansPerDegree;
    }
    record_ns_ = std::max(record_ns_, *t_ns);
    item.stream = kDavisImu;
    item.record_ns = record_ns_;
    item.content = sample;
    return true;
  }

  FileSource file_;
  SensorSize size_;
  std::vector<RecordedStream> streams_;
  std::vector<RecordingDamage> damage_;
  std::uint64_t offset_ = 0;
  PacketHeader packet_;
  std::int64_t left_ = 0;  ///< events of the packet
  std::int64_t record_ns_ = 0;
  std::vector<std::uint8_t> scratch_;
  std::vector<Event> events_;
  std::vector<std::uint8_t> pixels_;
  bool ended_ = false;
};

}  // namespace

std::unique_ptr<Recording> openAedat3(const std::string& path) {
  return std::make_unique<Aedat3Reader>(path);
}

}  // namespace fast_edi
