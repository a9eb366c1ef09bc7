#include "fast_edi/recording/aedat2_reader.hpp"

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "fast_edi/base/sensor_size.hpp"
#include "fast_edi/exposure/stamp_limits.hpp"
#include "fast_edi/recording/byte_source.hpp"
#include "fast_edi/recording/recording_error.hpp"
#include "recording/aedat2_clock.hpp"
#include "recording/aedat2_imu.hpp"
#include "recording/aps_frame.hpp"
#include "recording/damage_notes.hpp"
#include "recording/davis_geometry.hpp"
#include "recording/text_header.hpp"

namespace fast_edi {
namespace {

constexpr std::size_t kRecordBytes = 8;
constexpr std::size_t kBlockBytes = std::size_t{1} << 18;  ///< of whole records
constexpr std::int64_t kMaxItem_us = 10'000;               ///< an item spans no more

// Bits of an address.
constexpr std::uint32_t kNoEvent = 1U << 31;
constexpr int kRowShift = 22;
constexpr std::uint32_t kRowMask = 0x1ff;
constexpr int kColumnShift = 12;
constexpr std::uint32_t kColumnMask = 0x3ff;
constexpr std::uint32_t kOn = 1U << 11;
constexpr std::uint32_t kExternal = 1U << 10;  ///< of an event: a signal on the connector
constexpr int kReadShift = 10;
constexpr std::uint32_t kReadMask = 3;
constexpr std::uint32_t kSampleMask = 0x3ff;
constexpr int kImuCodeShift = 28;
constexpr std::uint32_t kImuCodeMask = 7;
constexpr int kImuDataShift = 12;

enum class Read : std::uint32_t { kResetRead = 0, kSignalRead = 1, kImuNumber = 3 };

std::uint32_t bigEndian(const std::uint8_t* data) {
  return static_cast<std::uint32_t>(data[0]) << 24 | static_cast<std::uint32_t>(data[1]) << 16 |
         static_cast<std::uint32_t>(data[2]) << 8 | data[3];
}

class Aedat2Reader : public Recording {
 public:
  explicit Aedat2Reader(const std::string& path) : file_(path) {
    const std::string camera = readHeader(path);
    streams_ = davisStreams(path, camera, "# AEChip: ...");
    size_ = streams_[kDavisEvents].size;
    frame_.emplace(size_);
  }

  bool next(RecordingItem& item) override {
    given_.clear();
    if (frame_->complete()) {
      frame_->clear();  // the one that was given last
    }
    while (const std::uint8_t* record = nextRecord()) {
      const std::uint32_t address = bigEndian(record);
      const bool event = (address & kNoEvent) == 0;
      const std::int64_t t_us = clock_.unwrapped(bigEndian(record + 4));
      if (event) {
        if (!given_.empty() &&
            (given_.size() == kMaxItemEvents || t_us - given_.front().t_ns / 1000 >= kMaxItem_us ||
             t_us * 1000 < given_.back().t_ns)) {
          return giveEvents(item);  // this one begins the next
        }
        addEvent(address, t_us);
      } else if (completes(address)) {
        if (!given_.empty()) {
          return giveEvents(item);
        }
        if (addOther(address, t_us, item)) {
          take();
          return true;
        }
      } else {
        addOther(address, t_us, item);
      }
      take();
    }
    if (given_.empty()) {
      noteEnd();
      return false;
    }
    return giveEvents(item);
  }

  std::string format() const override { return "AEDAT2"; }
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
    constexpr std::string_view kChip = "# AEChip: ";
    std::vector<std::uint8_t> scratch;
    std::string_view text = textHeader(file_, scratch);
    std::string camera;
    while (!text.empty() && text[0] == '#') {
      const std::size_t end = text.find('\n');
      if (end == std::string_view::npos) {
        throw RecordingError(path + ", byte " + std::to_string(offset_) +
                             ": a line without an end, expected lines beginning with # and "
                             "records behind them");
      }
      std::string_view line = text.substr(0, end);
      if (line.substr(0, kChip.size()) == kChip) {
        line.remove_prefix(kChip.size());
        camera = std::string(line.substr(0, line.find_last_not_of("\r ") + 1));
      }
      text.remove_prefix(end + 1);
      offset_ += end + 1;
    }
    return camera;
  }

  /// The record at offset_; nullptr at the end.
  const std::uint8_t* nextRecord() {
    if (offset_ >= block_begin_ && offset_ + kRecordBytes <= block_end_) {
      return block_.data() + (offset_ - block_begin_);
    }
    const std::uint64_t left = (file_.size() - offset_) / kRecordBytes * kRecordBytes;
    const auto bytes = static_cast<std::size_t>(std::min<std::uint64_t>(left, kBlockBytes));
    if (bytes == 0 || file_.read(offset_, bytes, block_) == nullptr) {
      return nullptr;
    }
    block_begin_ = offset_;
    block_end_ = offset_ + bytes;
    return block_.data();
  }

  void take() { offset_ += kRecordBytes; }

  void addEvent(std::uint32_t address, std::int64_t t_us) {
    clock_.advance(t_us);
    if ((address & kExternal) != 0) {
      return;
    }
    const int x = size_.width - 1 - static_cast<int>(address >> kColumnShift & kColumnMask);
    const int y = size_.height - 1 - static_cast<int>(address >> kRowShift & kRowMask);
    if (x < 0 || y < 0) {
      note(offset_, "an event at column " + std::to_string(address >> kColumnShift & kColumnMask) +
                        ", row " + std::to_string(address >> kRowShift & kRowMask) +
                        ", expected one within " + sizeText(size_.width, size_.height));
      return;
    }
    given_.push_back({static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y),
                      t_us * kNanosecondsPerMicrosecond, (address & kOn) != 0});
  }

  /// Whether a record may complete a frame or an IMU sample: what was read before is given first.
  bool completes(std::uint32_t address) const {
    const auto read = static_cast<Read>(address >> kReadShift & kReadMask);
    if (read == Read::kImuNumber) {
      return (address >> kImuCodeShift & kImuCodeMask) + 1 == Aedat2Imu::kNumbers;
    }
    return read == Read::kSignalRead && frame_->missesOneSignal();
  }

  /// \return whether \p item holds something
  bool addOther(std::uint32_t address, std::int64_t t_us, RecordingItem& item) {
    clock_.advance(t_us);
    const std::int64_t t_ns = t_us * kNanosecondsPerMicrosecond;
    const auto read = static_cast<Read>(address >> kReadShift & kReadMask);
    if (read == Read::kImuNumber) {
      return addImu(address, t_ns, item);
    }
    const int x = static_cast<int>(address >> kColumnShift & kColumnMask);
    const int y = size_.height - 1 - static_cast<int>(address >> kRowShift & kRowMask);
    const auto sample = static_cast<std::uint16_t>(address & kSampleMask);
    if (x >= size_.width || y < 0) {
      note(offset_, "a read of a pixel outside of " + sizeText(size_.width, size_.height));
      return false;
    }
    if (read == Read::kResetRead) {
      if (frame_->addReset(x, y, sample, t_ns)) {
        note(offset_, "a frame ends here before each of its pixels was read twice");
      }
    } else if (read == Read::kSignalRead) {
      frame_->addSignal(x, y, sample, t_ns);
    }
    return frame_->complete() && giveFrame(item);
  }

  bool addImu(std::uint32_t address, std::int64_t t_ns, RecordingItem& item) {
    const std::uint32_t code = address >> kImuCodeShift & kImuCodeMask;
    if (code >= Aedat2Imu::kNumbers) {
      note(offset_, "number 7 of an IMU sample, expected 0 to 6");
      return false;
    }
    const auto number =
        static_cast<std::int16_t>(static_cast<std::uint16_t>(address >> kImuDataShift));
    if (!imu_.add(code, number, t_ns)) {
      return false;
    }
    item.stream = kDavisImu;
    item.record_ns = clock_.latest();
    item.content = imu_.sample();
    return true;
  }

  bool giveFrame(RecordingItem& item) {
    RecordedFrame frame;
    frame.exposure = frame_->exposure();
    frame.stamp_ns = frame.exposure->at(ExposureInstant::kMid);
    frame.size = size_;
    frame.encoding = "mono16";
    const std::vector<std::uint16_t>& pixels = frame_->pixels();
    frame.pixels = reinterpret_cast<const std::uint8_t*>(pixels.data());
    frame.bytes = pixels.size() * sizeof(pixels[0]);
    item.stream = kDavisFrames;
    item.record_ns = clock_.latest();
    item.content = frame;
    return true;
  }

  bool giveEvents(RecordingItem& item) {
    item.stream = kDavisEvents;
    item.record_ns = clock_.latest();
    item.content = RecordedEvents{given_.data(), given_.size()};
    return true;
  }

  void noteEnd() {
    if (ended_) {
      return;
    }
    ended_ = true;
    if ((file_.size() - offset_) % kRecordBytes != 0) {
      note(offset_, "a record of " + std::to_string((file_.size() - offset_) % kRecordBytes) +
                        " bytes, expected 8: the file is cut");
    }
    if (!frame_->empty()) {
      note(offset_, "the recording ends within a frame");
    }
  }

  FileSource file_;
  SensorSize size_;
  std::vector<RecordedStream> streams_;
  std::vector<RecordingDamage> damage_;
  std::uint64_t offset_ = 0;
  std::vector<std::uint8_t> block_;
  std::uint64_t block_begin_ = 0;
  std::uint64_t block_end_ = 0;
  Aedat2Clock clock_;
  std::vector<Event> given_;
  std::optional<ApsFrame> frame_;
  Aedat2Imu imu_;
  bool ended_ = false;
};

}  // namespace

std::unique_ptr<Recording> openAedat2(const std::string& path) {
  return std::make_unique<Aedat2Reader>(path);
}

}  // namespace fast_edi
