#include "fast_edi/recording/aedat4_writer.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <optional>

#include "fast_edi/recording/aedat4_reader.hpp"
#include "fast_edi/recording/recording_error.hpp"
#include "recording/aedat4_header.hpp"
#include "recording/flatbuffer_writer.hpp"
#include "recording/imu_units.hpp"
#include "recording/output_path.hpp"
#include "recording/packet_compression.hpp"

namespace fast_edi {
namespace {

using Field = FlatBufferWriter::Field;
using Reference = FlatBufferWriter::Reference;

constexpr double kDegreesPerRadian = 57.29577951308232;
/// IMU samples of one packet, as DV has them.
constexpr std::size_t kPacketSamples = 10;
constexpr std::int8_t kFrameFromSensor = 1;

struct WrittenEvent {
  std::int64_t t_us = 0;
  std::int16_t x = 0;
  std::int16_t y = 0;
  std::uint8_t on = 0;
  std::array<std::uint8_t, 3> padding = {};
};
static_assert(sizeof(WrittenEvent) == 16, "as the format has it");

struct TableRow {
  std::int64_t offset = 0;
  std::int32_t stream = 0;
  std::int32_t size = 0;
  std::int64_t elements = 0;
  std::int64_t first_us = 0;
  std::int64_t last_us = 0;
};

std::int64_t microseconds(std::int64_t t_ns) {
  return t_ns / kNanosecondsPerMicrosecond;
}

Compression compressionOf(Aedat4Compression compression) {
  switch (compression) {
    case Aedat4Compression::kLz4:
      return Compression::kLz4;
    case Aedat4Compression::kZstd:
      return Compression::kZstd;
    case Aedat4Compression::kNone:
      break;
  }
  return Compression::kNone;
}

const char* identifierOf(StreamKind kind) {
  switch (kind) {
    case StreamKind::kEvents:
      return kAedat4Events;
    case StreamKind::kFrames:
      return kAedat4Frames;
    case StreamKind::kImu:
      return kAedat4Imu;
    case StreamKind::kTriggers:
      return kAedat4Triggers;
    case StreamKind::kCalibration:
      break;
  }
  return nullptr;
}

const char* outputName(StreamKind kind) {
  switch (kind) {
    case StreamKind::kEvents:
      return "events";
    case StreamKind::kFrames:
      return "frames";
    case StreamKind::kImu:
      return "imu";
    default:
      return "triggers";
  }
}

std::string escaped(const std::string& text) {
  std::string xml;
  for (const char c : text) {
    switch (c) {
      case '<':
        xml += "&lt;";
        break;
      case '&':
        xml += "&amp;";
        break;
      case '"':
        xml += "&quot;";
        break;
      default:
        xml += c;
    }
  }
  return xml;
}

std::string xmlAttribute(const char* key, const char* type, const std::string& value) {
  return std::string("<attr key=\"") + key + "\" type=\"" + type + "\">" + escaped(value) +
         "</attr>\n";
}

/// DV's description of the streams.
std::string description(const std::vector<RecordedStream>& streams, Compression compression) {
  const char* name = compression == Compression::kLz4    ? "LZ4"
                     : compression == Compression::kZstd ? "ZSTD"
                                                         : "NONE";
  std::string xml = "<dv version=\"2.0\">\n<node name=\"outInfo\" path=\"/outInfo/\">\n";
  for (std::size_t i = 0; i < streams.size(); ++i) {
    const RecordedStream& stream = streams[i];
    const char* identifier = identifierOf(stream.kind);
    if (identifier == nullptr) {
      continue;
    }
    const std::string number = std::to_string(i);
    const std::string path = "/outInfo/" + number + "/";
    xml += "<node name=\"" + number + "\" path=\"" + path + "\">\n";
    xml += xmlAttribute("compression", "string", name);
    xml += xmlAttribute("originalModuleName", "string", "fast_edi");
    xml += xmlAttribute("originalOutputName", "string",
                        stream.name.empty() ? outputName(stream.kind) : stream.name);
    xml += xmlAttribute("typeDescription", "string", outputName(stream.kind));
    xml += xmlAttribute("typeIdentifier", "string", identifier);
    xml += "<node name=\"info\" path=\"" + path + "info/\">\n";
    if (stream.size.pixelCount() > 0) {
      xml += xmlAttribute("sizeX", "int", std::to_string(stream.size.width));
      xml += xmlAttribute("sizeY", "int", std::to_string(stream.size.height));
    }
    xml += xmlAttribute("source", "string", stream.camera.empty() ? "DAVIS" : stream.camera);
    xml += "</node>\n</node>\n";
  }
  return xml + "</node>\n</dv>\n";
}

/// OpenCV's type of an encoding; RGB is turned to BGR.
struct FrameFormat {
  std::int8_t type;
  int channels;
  bool swapped;  ///< red first
};

std::optional<FrameFormat> formatOf(const std::string& encoding) {
  if (encoding == "mono8" || encoding == "8UC1" || encoding.rfind("bayer_", 0) == 0) {
    return encoding.find("16") == std::string::npos ? std::optional(FrameFormat{0, 1, false})
                                                    : std::optional(FrameFormat{2, 1, false});
  }
  if (encoding == "mono16") {
    return FrameFormat{2, 1, false};
  }
  if (encoding == "bgr8" || encoding == "rgb8") {
    return FrameFormat{16, 3, encoding == "rgb8"};
  }
  if (encoding == "bgra8" || encoding == "rgba8") {
    return FrameFormat{24, 4, encoding == "rgba8"};
  }
  return std::nullopt;
}

}  // namespace

class Aedat4Writer::Impl {
 public:
  Impl(const std::string& path, const std::vector<RecordedStream>& streams,
       Aedat4Compression compression, bool overwrite)
      : path_(path, overwrite),
        streams_(streams),
        compression_(compressionOf(compression)),
        pending_samples_(streams.size()) {
    errno = 0;
    file_.open(path_.active(), std::ios::binary | std::ios::trunc);
    requireWritten();
    writeHeader(static_cast<std::int32_t>(compression));
  }

  void write(const RecordingItem& item) {
    if (const auto* events = std::get_if<RecordedEvents>(&item.content)) {
      for (std::size_t done = 0; done < events->count; done += kPacketEvents) {
        writeEvents(item.stream, events->data + done,
                    std::min(kPacketEvents, events->count - done));
      }
    } else if (const auto* frame = std::get_if<RecordedFrame>(&item.content)) {
      writeFrame(item.stream, *frame);
    } else if (const auto* sample = std::get_if<RecordedImu>(&item.content)) {
      std::vector<RecordedImu>& pending = pending_samples_.at(item.stream);
      pending.push_back(*sample);
      if (pending.size() == kPacketSamples) {
        writeSamples(item.stream);
      }
    } else if (const auto* trigger = std::get_if<RecordedTrigger>(&item.content)) {
      writeTrigger(item.stream, *trigger);
    }
  }

  void close() {
    for (std::size_t stream = 0; stream < streams_.size(); ++stream) {
      writeSamples(stream);
    }
    writeTable();
    errno = 0;
    file_.close();
    requireWritten();
    path_.complete();
  }

 private:
  void requireWritten() const {
    if (!file_) {
      throw RecordingError("cannot write " + path_.active() + ": " +
                           (errno != 0 ? std::strerror(errno) : "unknown error"));
    }
  }

  void put(const void* bytes, std::size_t size) {
    errno = 0;
    file_.write(static_cast<const char*>(bytes), static_cast<std::streamsize>(size));
    requireWritten();
    offset_ += static_cast<std::int64_t>(size);
  }

  void writeHeader(std::int32_t compression) {
    FlatBufferWriter buffer(kAedat4Header);
    std::vector<Reference> places;
    buffer.setRoot(buffer.table(
        {FlatBufferWriter::number<std::int32_t>(0, compression),
         FlatBufferWriter::number<std::int64_t>(1, -1), FlatBufferWriter::reference(2)},
        places));
    buffer.text(places[2], description(streams_, compression_));
    constexpr std::size_t kMagicBytes = sizeof(Aedat4Reader::kMagic) - 1;
    table_place_ = static_cast<std::streamoff>(kMagicBytes + places[1]);
    put(Aedat4Reader::kMagic, kMagicBytes);
    const std::vector<std::uint8_t>& bytes = buffer.finish();
    put(bytes.data(), bytes.size());
  }

  const std::vector<std::uint8_t>& compressed(const std::vector<std::uint8_t>& bytes) {
    if (compression_ == Compression::kNone) {
      return bytes;
    }
    compress(compression_, bytes.data(), bytes.size(), compressed_);
    return compressed_;
  }

  void writePacket(std::size_t stream, const std::vector<std::uint8_t>& plain, std::size_t elements,
                   std::int64_t first_us, std::int64_t last_us) {
    const std::vector<std::uint8_t>& data = compressed(plain);
    TableRow row;
    row.stream = static_cast<std::int32_t>(stream);
    row.size = static_cast<std::int32_t>(data.size());
    put(&row.stream, sizeof(row.stream));
    put(&row.size, sizeof(row.size));
    row.offset = offset_;
    row.elements = static_cast<std::int64_t>(elements);
    row.first_us = first_us;
    row.last_us = last_us;
    put(data.data(), data.size());
    table_.push_back(row);
  }

  void writeEvents(std::size_t stream, const Event* events, std::size_t count) {
    written_.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
      written_[i].t_us = microseconds(events[i].t_ns);
      written_[i].x = static_cast<std::int16_t>(events[i].x);
      written_[i].y = static_cast<std::int16_t>(events[i].y);
      written_[i].on = events[i].on ? 1 : 0;
    }
    FlatBufferWriter buffer(kAedat4Events);
    std::vector<Reference> places;
    buffer.setRoot(buffer.table({FlatBufferWriter::reference(0)}, places));
    buffer.vector(places[0], written_.data(), count, sizeof(WrittenEvent), alignof(std::int64_t));
    writePacket(stream, buffer.finish(), count, written_.front().t_us, written_.back().t_us);
  }

  void writeFrame(std::size_t stream, const RecordedFrame& frame) {
    const std::optional<FrameFormat> format = formatOf(frame.encoding);
    if (!format) {
      throw RecordingError("a frame with the encoding " + frame.encoding +
                           " cannot be written as AEDAT4, which has mono8, mono16, bgr8, bgra8");
    }
    const ExposureInterval exposure =
        frame.exposure.value_or(ExposureInterval{frame.stamp_ns, frame.stamp_ns});
    const std::int64_t start_us = microseconds(exposure.start_ns);
    const std::int64_t end_us = microseconds(exposure.end_ns);
    FlatBufferWriter buffer(kAedat4Frames);
    std::vector<Reference> places;
    buffer.setRoot(buffer.table(
        {FlatBufferWriter::number(0, start_us), FlatBufferWriter::number(1, start_us),
         FlatBufferWriter::number(2, end_us), FlatBufferWriter::number(3, start_us),
         FlatBufferWriter::number(4, end_us), FlatBufferWriter::number(5, format->type),
         FlatBufferWriter::number(6, static_cast<std::int16_t>(frame.size.width)),
         FlatBufferWriter::number(7, static_cast<std::int16_t>(frame.size.height)),
         FlatBufferWriter::number<std::int16_t>(8, 0), FlatBufferWriter::number<std::int16_t>(9, 0),
         FlatBufferWriter::reference(10), FlatBufferWriter::number(11, end_us - start_us),
         FlatBufferWriter::number(12, kFrameFromSensor)},
        places));
    const std::uint8_t* pixels = frame.pixels;
    if (format->swapped) {
      swapped_.assign(frame.pixels, frame.pixels + frame.bytes);
      const auto step = static_cast<std::size_t>(format->channels);
      for (std::size_t i = 0; i + step <= swapped_.size(); i += step) {
        std::swap(swapped_[i], swapped_[i + 2]);
      }
      pixels = swapped_.data();
    }
    buffer.vector(places[10], pixels, frame.bytes, 1, 1);
    writePacket(stream, buffer.finish(), 1, start_us, end_us);
  }

  void writeSamples(std::size_t stream) {
    std::vector<RecordedImu>& samples = pending_samples_[stream];
    if (samples.empty()) {
      return;
    }
    FlatBufferWriter buffer(kAedat4Imu);
    std::vector<Reference> places;
    buffer.setRoot(buffer.table({FlatBufferWriter::reference(0)}, places));
    const std::vector<Reference> references = buffer.references(places[0], samples.size());
    for (std::size_t i = 0; i < samples.size(); ++i) {
      std::vector<Field> fields = {FlatBufferWriter::number(0, microseconds(samples[i].t_ns)),
                                   FlatBufferWriter::number(1, 0.0F)};
      int index = 2;
      for (const double acceleration : samples[i].acceleration) {
        fields.push_back(
            FlatBufferWriter::number(index++, static_cast<float>(acceleration / kStandardGravity)));
      }
      for (const double velocity : samples[i].angular_velocity) {
        fields.push_back(
            FlatBufferWriter::number(index++, static_cast<float>(velocity * kDegreesPerRadian)));
      }
      buffer.refer(references[i], buffer.table(fields, places));
    }
    writePacket(stream, buffer.finish(), samples.size(), microseconds(samples.front().t_ns),
                microseconds(samples.back().t_ns));
    samples.clear();
  }

  void writeTrigger(std::size_t stream, const RecordedTrigger& trigger) {
    FlatBufferWriter buffer(kAedat4Triggers);
    std::vector<Reference> places;
    buffer.setRoot(buffer.table({FlatBufferWriter::reference(0)}, places));
    const std::vector<Reference> references = buffer.references(places[0], 1);
    const std::int64_t t_us = microseconds(trigger.t_ns);
    buffer.refer(references[0],
                 buffer.table({FlatBufferWriter::number(0, t_us),
                               FlatBufferWriter::number(1, static_cast<std::int8_t>(trigger.type))},
                              places));
    writePacket(stream, buffer.finish(), 1, t_us, t_us);
  }

  void writeTable() {
    FlatBufferWriter buffer(kAedat4Table);
    std::vector<Reference> places;
    buffer.setRoot(buffer.table({FlatBufferWriter::reference(0)}, places));
    const std::vector<Reference> references = buffer.references(places[0], table_.size());
    for (std::size_t i = 0; i < table_.size(); ++i) {
      const TableRow& row = table_[i];
      Field packet{1, std::vector<std::uint8_t>(sizeof(row.stream) + sizeof(row.size)),
                   alignof(std::int32_t)};
      std::memcpy(packet.bytes.data(), &row.stream, sizeof(row.stream));
      std::memcpy(packet.bytes.data() + sizeof(row.stream), &row.size, sizeof(row.size));
      buffer.refer(references[i], buffer.table({FlatBufferWriter::number(0, row.offset), packet,
                                                FlatBufferWriter::number(2, row.elements),
                                                FlatBufferWriter::number(3, row.first_us),
                                                FlatBufferWriter::number(4, row.last_us)},
                                               places));
    }
    const std::int64_t place = offset_;
    const std::vector<std::uint8_t>& data = compressed(buffer.finish());
    put(data.data(), data.size());
    file_.seekp(table_place_);
    put(&place, sizeof(place));
  }

  const OutputPath path_;
  const std::vector<RecordedStream> streams_;
  const Compression compression_;
  std::ofstream file_;
  std::int64_t offset_ = 0;         ///< bytes written
  std::streamoff table_place_ = 0;  ///< of the header's field with the place of the table
  std::vector<TableRow> table_;
  std::vector<std::vector<RecordedImu>> pending_samples_;  ///< of each stream
  std::vector<WrittenEvent> written_;
  std::vector<std::uint8_t> compressed_;
  std::vector<std::uint8_t> swapped_;
};

Aedat4Writer::Aedat4Writer(const std::string& path, const std::vector<RecordedStream>& streams,
                           Aedat4Compression compression, bool overwrite)
    : impl_(std::make_unique<Impl>(path, streams, compression, overwrite)) {}
Aedat4Writer::~Aedat4Writer() = default;

void Aedat4Writer::write(const RecordingItem& item) {
  impl_->write(item);
}
void Aedat4Writer::close() {
  impl_->close();
}

}  // namespace fast_edi
