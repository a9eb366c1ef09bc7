#include "fast_edi/recording/rosbag2_reader.hpp"

#include <algorithm>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <string_view>
#include <utility>

#include "fast_edi/exposure/stamp_limits.hpp"
#include "fast_edi/recording/recording_error.hpp"
#include "recording/cdr_reader.hpp"
#include "recording/damage_notes.hpp"
#include "recording/event_array_decoder.hpp"
#include "recording/event_packet_decoder.hpp"
#include "recording/file_decompression.hpp"
#include "recording/packet_compression.hpp"
#include "recording/ros_image.hpp"
#include "recording/rosbag2_files.hpp"
#include "recording/rosbag2_topics.hpp"

namespace fast_edi {
namespace {

constexpr char kFormatOfMessages[] = "cdr";
/// Messages that are looked at for the size of the sensor.
constexpr int kMessagesLookedAt = 1000;
/// What position() is at the end of each file.
constexpr double kStepsPerFile = 1'000'000.0;
constexpr std::uint32_t kMaxSide_px = 32'767;
constexpr std::size_t kMaxDistortion = 64;

/// Seconds and nanoseconds of a header or an event.
std::int64_t readTime(CdrReader& cdr) {
  const auto seconds = cdr.number<std::int32_t>();
  const auto nanoseconds = cdr.number<std::uint32_t>();
  return seconds * kNanosecondsPerSecond + nanoseconds;
}

std::int64_t readHeader(CdrReader& cdr) {
  const std::int64_t stamp_ns = readTime(cdr);
  cdr.text();  // frame_id
  return stamp_ns;
}

SensorSize sizeOf(std::uint32_t width, std::uint32_t height) {
  return width <= kMaxSide_px && height <= kMaxSide_px
             ? SensorSize{static_cast<int>(width), static_cast<int>(height)}
             : SensorSize{};
}

class Rosbag2Reader : public Recording {
 public:
  explicit Rosbag2Reader(const std::string& path) : files_(findRosbag2Files(path)) {
    for (const std::string& fault : files_.faults) {
      addNote({0, fault});
    }
    if (!openFile()) {
      throw RecordingError(path + ": none of its " + std::to_string(files_.paths.size()) +
                           " files can be read; " + damage_.back().what);
    }
    findStreams();
    const std::size_t notes = damage_.size();
    findSizes();
    damage_.resize(notes);
    sources_.clear();
    file_->storage().rewind();
  }

  bool next(RecordingItem& item) override {
    for (;;) {
      if (giveEvents(item)) {
        return true;
      }
      Rosbag2Message message;
      if (!nextMessage(message)) {
        return giveLastFrame(item);
      }
      if (take(message, item)) {
        return true;
      }
    }
  }

  std::string format() const override { return format_; }
  const std::vector<RecordedStream>& streams() const override { return topics_.streams; }
  const std::vector<RecordingDamage>& damage() const override { return damage_; }
  std::uint64_t position() const override {
    const double of_file = file_ ? file_->storage().progress() : 0.0;
    return static_cast<std::uint64_t>((static_cast<double>(file_index_) + of_file) * kStepsPerFile);
  }
  std::uint64_t length() const override {
    return static_cast<std::uint64_t>(static_cast<double>(files_.paths.size()) * kStepsPerFile);
  }
  std::uint64_t fileSize() const override { return file_size_; }

 private:
  struct Frame {
    std::int64_t stamp_ns = 0;
    SensorSize size;
    std::string encoding;
    std::vector<std::uint8_t> pixels;
  };
  /// What is kept of a topic from message to message.
  struct State {
    EventPacketDecoder packets;
    std::optional<std::uint64_t> sequence;  ///< of the last packet of events
    std::uint64_t lost = 0;                 ///< packets before the next events
    std::optional<Frame> waiting;           ///< for its exposure; of the frames' topic
  };

  void addNote(const RecordingDamage& damage) { noteDamage(damage_, damage); }
  void noteOf(const Rosbag2Message& message, const std::string& what) {
    addNote({message.offset, where() + topicOf(message).name + ": " + what});
  }
  /// The file, where there are several.
  std::string where() const {
    if (files_.paths.size() == 1) {
      return {};
    }
    const std::string& path = file_->path();
    return path.substr(path.rfind('/') + 1) + ": ";
  }
  const Rosbag2Topic& topicOf(const Rosbag2Message& message) const {
    return file_->storage().topics()[message.topic];
  }

  /// \return false when there is none, or it cannot be read
  bool openFile() {
    notes_of_file_ = 0;
    while (!file_ && file_index_ < files_.paths.size()) {
      const std::string& path = files_.paths[file_index_];
      try {
        file_ = std::make_unique<Rosbag2File>(path);
      } catch (const RecordingError& error) {
        if (files_.paths.size() == 1) {
          throw;
        }
        addNote({0, error.what()});
        ++file_index_;
        continue;
      }
      if (!file_->fault().empty()) {
        addNote({0, where() + file_->fault()});
      }
      sources_.clear();
    }
    return file_ != nullptr;
  }

  void copyNotes() {
    const std::vector<RecordingDamage>& notes = file_->storage().damage();
    for (; notes_of_file_ < notes.size(); ++notes_of_file_) {
      addNote({notes[notes_of_file_].offset, where() + notes[notes_of_file_].what});
    }
  }

  bool nextMessage(Rosbag2Message& message) {
    while (openFile()) {
      const bool found = file_->storage().next(message);
      copyNotes();
      if (found) {
        ++messages_;
        return true;
      }
      file_.reset();
      ++file_index_;
    }
    if (files_.messages.value_or(messages_) > messages_ && !noted_missing_) {
      noted_missing_ = true;
      addNote({0, std::to_string(messages_) + " messages are found, expected " +
                      std::to_string(*files_.messages)});
    }
    return false;
  }

  /// By metadata.yaml and the first file; without metadata by all of them.
  void findStreams() {
    std::vector<Rosbag2Topic> topics = files_.topics;
    const auto add_topics = [&topics](const Rosbag2Storage& storage) {
      topics.insert(topics.end(), storage.topics().begin(), storage.topics().end());
    };
    add_topics(file_->storage());
    format_ = "rosbag2, " + file_->storage().format() +
              (file_->isCompressed() ? ", compressed by file" : "");
    for (const std::string& path : files_.paths) {
      std::error_code ignored;  // of no file that can be read
      const std::uintmax_t size = std::filesystem::file_size(path, ignored);
      file_size_ += ignored ? 0 : size;
      if (files_.topics.empty() && path != file_->path()) {
        try {
          add_topics(Rosbag2File(path).storage());
        } catch (const RecordingError&) {
          continue;  // noted when it is its turn
        }
      }
    }
    topics_ = streamsOf(topics);
    states_.resize(topics_.sources.size());
  }

  /// What the first message of events or frames says; of events that have none, the frames'.
  void findSizes() {
    const auto is_missing = [this] {
      return std::any_of(topics_.streams.begin(), topics_.streams.end(), [](const auto& stream) {
        return (stream.kind == StreamKind::kEvents || stream.kind == StreamKind::kFrames) &&
               stream.size.pixelCount() == 0;
      });
    };
    Rosbag2Message message;
    for (int i = 0; i < kMessagesLookedAt && is_missing() && file_->storage().next(message); ++i) {
      const std::optional<std::size_t> source = sourceOf(message);
      if (!source || !uncompress(message)) {
        continue;
      }
      RecordedStream& stream = topics_.streams[topics_.sources[*source].stream];
      const bool has_size =
          stream.kind == StreamKind::kEvents || stream.kind == StreamKind::kFrames;
      if (has_size && topics_.sources[*source].kind != Rosbag2Kind::kExposure &&
          stream.size.pixelCount() == 0) {
        CdrReader cdr(message.data, message.size);
        readHeader(cdr);
        const auto height = cdr.number<std::uint32_t>();
        const auto width = cdr.number<std::uint32_t>();
        stream.size = sizeOf(width, height);
      }
    }
    for (RecordedStream& stream : topics_.streams) {
      const auto frames = std::find_if(
          topics_.streams.begin(), topics_.streams.end(), [&](const RecordedStream& other) {
            return other.kind == StreamKind::kFrames && other.camera == stream.camera;
          });
      if (stream.kind == StreamKind::kEvents && stream.size.pixelCount() == 0 &&
          frames != topics_.streams.end()) {
        stream.size = frames->size;
      }
    }
  }

  std::optional<std::size_t> sourceOf(const Rosbag2Message& message) {
    const auto known = sources_.find(message.topic);
    if (known != sources_.end()) {
      return known->second;
    }
    const Rosbag2Topic& topic = topicOf(message);
    std::optional<std::size_t> source = topics_.find(topic);
    if (source && topic.format != kFormatOfMessages) {
      noteOf(message, "messages in the format \"" + topic.format + "\", expected cdr: left out");
      source.reset();
    } else if (!source && kindOf(topic.type) && kindOf(topic.type) != Rosbag2Kind::kExposure) {
      noteOf(message, "a topic that neither metadata.yaml nor the files' heads tell of: left out");
    }
    sources_[message.topic] = source;
    return source;
  }

  /// Decompresses a message that was compressed by itself.
  bool uncompress(Rosbag2Message& message) {
    if (!beginsWithZstd(message.data, message.size)) {
      return true;
    }
    const std::string fault = decompressor_.run(Compression::kZstd, message.data, message.size,
                                                Rosbag2Storage::kMaxMessageBytes, uncompressed_);
    if (!fault.empty()) {
      noteOf(message, fault);
    }
    message.data = uncompressed_.data();
    message.size = uncompressed_.size();
    return !uncompressed_.empty();
  }

  bool take(Rosbag2Message message, RecordingItem& item) {
    const std::optional<std::size_t> source = sourceOf(message);
    if (!source || !uncompress(message)) {
      return false;
    }
    if (isStamp(message.record_ns)) {
      record_ns_ = std::max(record_ns_, message.record_ns);
    } else {
      noteOf(message, "recorded before 1970 or after 2106");
    }
    const Rosbag2Source& of = topics_.sources[*source];
    State& state = states_[*source];
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
        return takeImage(state, message, cdr, item);
      case Rosbag2Kind::kImu:
        return takeImu(message, cdr, item);
      case Rosbag2Kind::kCalibration:
        return takeCalibration(message, cdr, item);
      case Rosbag2Kind::kExposure:
        break;
    }
    return takeExposure(message, cdr, item);
  }

  bool refuse(const Rosbag2Message& message, const std::string& what) {
    noteOf(message, what + ": left out");
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
      noteOf(message, "an array of " + std::to_string(count) + " events, " +
                          std::to_string(array_.left()) + " of which are there");
    }
    startEvents(source, message);
  }

  void beginPacket(std::size_t source, const Rosbag2Message& message, CdrReader& cdr) {
    State& state = states_[source];
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
      noteOf(message,
             "a packet of events that is cut: " + std::to_string(bytes.size) + " bytes are there");
    }
    packet.data = bytes.data;
    packet.size = bytes.size;
    const std::string fault = state.packets.begin(packet);
    if (!fault.empty()) {
      noteOf(message, fault);
    }
    if (state.sequence && sequence > *state.sequence + 1) {
      const std::uint64_t lost = sequence - *state.sequence - 1;
      noteOf(message, std::to_string(lost) + " packets of events were lost before this one, when " +
                          "they were recorded");
      state.lost += lost;
    }
    state.sequence = sequence;
    startEvents(source, message);
  }

  void startEvents(std::size_t source, const Rosbag2Message& message) {
    events_source_ = source;
    events_message_ = message;
  }

  bool giveEvents(RecordingItem& item) {
    while (events_source_) {
      const Rosbag2Source& source = topics_.sources[*events_source_];
      State& state = states_[*events_source_];
      events_.clear();
      const bool is_packet = source.kind == Rosbag2Kind::kEventPacket;
      const bool more = is_packet ? state.packets.decode(events_, kMaxItemEvents)
                                  : array_.decode(events_, kMaxItemEvents);
      if (!more) {
        finishEvents(is_packet ? state.packets.untold() : array_.untold(),
                     is_packet ? state.packets.unknownWords() : 0);
      }
      if (events_.empty()) {
        continue;
      }
      RecordedEvents given{events_.data(), events_.size()};
      given.lost_arrays = static_cast<std::uint32_t>(
          std::min<std::uint64_t>(state.lost, std::numeric_limits<std::uint16_t>::max()));
      state.lost = 0;
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
      noteOf(events_message_,
             std::to_string(untold) + " events with times before 1970 or after 2106");
    }
    if (unknown_words > 0) {
      noteOf(events_message_,
             std::to_string(unknown_words) + " words with a code that the encoding does not have");
    }
  }

  bool hasExposures(std::size_t stream) const {
    return std::any_of(topics_.sources.begin(), topics_.sources.end(),
                       [stream](const auto& source) {
                         return source.kind == Rosbag2Kind::kExposure && source.stream == stream;
                       });
  }

  bool takeImage(State& state, const Rosbag2Message& message, CdrReader& cdr, RecordingItem& item) {
    const std::int64_t stamp_ns = readHeader(cdr);
    RosImage image;
    image.height = cdr.number<std::uint32_t>();
    image.width = cdr.number<std::uint32_t>();
    image.encoding = cdr.text();
    image.big_endian = cdr.number<std::uint8_t>() != 0;
    image.step = cdr.number<std::uint32_t>();
    const CdrBytes data = cdr.bytes();
    if (!cdr.ok()) {
      return refuseCut(message);
    }
    image.data = data.data;
    image.bytes = data.size;
    Frame frame;
    std::swap(frame.pixels, spare_pixels_);
    const std::string fault = packImage(image, frame.pixels);
    if (!fault.empty() || !isStamp(stamp_ns)) {
      return refuse(message,
                    fault.empty() ? "a frame with a time before 1970 or after 2106" : fault);
    }
    frame.stamp_ns = stamp_ns;
    frame.size = sizeOf(image.width, image.height);
    frame.encoding = std::string(image.encoding);
    if (!hasExposures(item.stream)) {
      return giveFrame(std::move(frame), std::nullopt, item);
    }
    // Its predecessor's exposure did not come.
    std::optional<Frame> before = std::move(state.waiting);
    state.waiting = std::move(frame);
    return before && giveFrame(std::move(*before), std::nullopt, item);
  }

  bool takeExposure(const Rosbag2Message& message, CdrReader& cdr, RecordingItem& item) {
    const std::int64_t exposure_us = cdr.number<std::int32_t>();
    if (!cdr.ok()) {
      return refuseCut(message);
    }
    for (std::size_t i = 0; i < topics_.sources.size(); ++i) {
      if (topics_.sources[i].kind == Rosbag2Kind::kImage &&
          topics_.sources[i].stream == item.stream && states_[i].waiting) {
        Frame frame = std::move(*states_[i].waiting);
        states_[i].waiting.reset();
        return giveFrame(std::move(frame),
                         exposure_us > 0 ? std::optional(exposure_us * kNanosecondsPerMicrosecond)
                                         : std::nullopt,
                         item);
      }
    }
    return false;  // of a frame that came before the recording began
  }

  bool giveLastFrame(RecordingItem& item) {
    for (std::size_t i = 0; i < states_.size(); ++i) {
      if (states_[i].waiting) {
        item.stream = topics_.sources[i].stream;
        item.record_ns = record_ns_;
        Frame frame = std::move(*states_[i].waiting);
        states_[i].waiting.reset();
        return giveFrame(std::move(frame), std::nullopt, item);
      }
    }
    return false;
  }

  bool giveFrame(Frame&& given, std::optional<std::int64_t> exposure_ns, RecordingItem& item) {
    spare_pixels_ = std::move(given_.pixels);
    given_ = std::move(given);
    RecordedFrame frame;
    frame.stamp_ns = given_.stamp_ns;
    if (exposure_ns) {
      // The driver's rule: see ExposureInterval::at().
      const std::int64_t half_us = *exposure_ns / 2 / kNanosecondsPerMicrosecond;
      const std::int64_t start_ns = frame.stamp_ns - half_us * kNanosecondsPerMicrosecond;
      frame.exposure = ExposureInterval{start_ns, start_ns + *exposure_ns};
    }
    frame.size = given_.size;
    frame.encoding = given_.encoding;
    frame.pixels = given_.pixels.data();
    frame.bytes = given_.pixels.size();
    item.content = frame;
    return true;
  }

  bool takeImu(const Rosbag2Message& message, CdrReader& cdr, RecordingItem& item) {
    constexpr std::size_t kQuaternion = 4;
    constexpr std::size_t kCovariance = 9;
    RecordedImu sample;
    sample.t_ns = readHeader(cdr);
    cdr.skipDoubles(kQuaternion + kCovariance);
    cdr.doubles(sample.angular_velocity.data(), sample.angular_velocity.size());
    cdr.skipDoubles(kCovariance);
    cdr.doubles(sample.acceleration.data(), sample.acceleration.size());
    if (!cdr.ok()) {
      return refuseCut(message);
    }
    if (!isStamp(sample.t_ns)) {
      return refuse(message, "an IMU sample with a time before 1970 or after 2106");
    }
    item.content = sample;
    return true;
  }

  bool takeCalibration(const Rosbag2Message& message, CdrReader& cdr, RecordingItem& item) {
    RecordedCalibration calibration;
    readHeader(cdr);
    const auto height = cdr.number<std::uint32_t>();
    const auto width = cdr.number<std::uint32_t>();
    calibration.size = sizeOf(width, height);
    calibration.distortion_model = std::string(cdr.text());
    const auto count = cdr.number<std::uint32_t>();
    if (count > kMaxDistortion) {
      return refuse(message, "a calibration with " + std::to_string(count) +
                                 " coefficients of distortion, expected at most " +
                                 std::to_string(kMaxDistortion));
    }
    calibration.distortion.resize(count);
    cdr.doubles(calibration.distortion.data(), count);
    cdr.doubles(calibration.camera_matrix.data(), calibration.camera_matrix.size());
    cdr.doubles(calibration.rectification.data(), calibration.rectification.size());
    cdr.doubles(calibration.projection.data(), calibration.projection.size());
    if (!cdr.ok()) {
      return refuseCut(message);
    }
    item.content = std::move(calibration);
    return true;
  }

  const Rosbag2Files files_;
  std::string format_;
  std::uint64_t file_size_ = 0;
  Rosbag2Streams topics_;
  std::vector<State> states_;  ///< of each source
  std::vector<RecordingDamage> damage_;
  Decompressor decompressor_;

  std::size_t file_index_ = 0;
  std::unique_ptr<Rosbag2File> file_;
  std::size_t notes_of_file_ = 0;  ///< that were copied
  /// By the file's numbers of topics; nothing for those that are not read.
  std::map<std::size_t, std::optional<std::size_t>> sources_;
  std::uint64_t messages_ = 0;
  bool noted_missing_ = false;
  std::int64_t record_ns_ = 0;
  std::vector<std::uint8_t> uncompressed_;

  /// Whose events are being decoded; nothing: none.
  std::optional<std::size_t> events_source_;
  Rosbag2Message events_message_;
  EventArrayDecoder array_;
  std::vector<Event> events_;

  Frame given_;  ///< that next() returned last
  std::vector<std::uint8_t> spare_pixels_;
};

}  // namespace

std::unique_ptr<Recording> openRosbag2(const std::string& path) {
  return std::make_unique<Rosbag2Reader>(path);
}

}  // namespace fast_edi
