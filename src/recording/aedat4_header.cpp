#include "recording/aedat4_header.hpp"

#include <tinyxml2.h>

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <string_view>

#include "fast_edi/recording/aedat4_reader.hpp"
#include "fast_edi/recording/recording_error.hpp"
#include "recording/flatbuffer.hpp"

namespace fast_edi {
namespace {

constexpr std::size_t kMagicBytes = sizeof(Aedat4Reader::kMagic) - 1;
constexpr std::uint32_t kMaxIoHeaderBytes = 16 << 20;
/// Larger tables are not read: the file is then read in its own order.
constexpr std::size_t kMaxTableBytes = std::size_t{256} << 20;

// Fields of the tables.
constexpr int kHeaderCompression = 0;
constexpr int kHeaderDataTable = 1;
constexpr int kHeaderInfo = 2;
constexpr int kTableEntries = 0;
constexpr int kEntryOffset = 0;
constexpr int kEntryPacket = 1;
constexpr int kEntryEnd = 4;

using tinyxml2::XMLElement;

std::string attribute(const XMLElement& node, const char* name) {
  const char* value = node.Attribute(name);
  return value == nullptr ? std::string() : value;
}

/// The text of the attribute \p key of a node of DV's configuration tree.
std::string valueOf(const XMLElement& node, const std::string& key) {
  for (const XMLElement* child = node.FirstChildElement("attr"); child != nullptr;
       child = child->NextSiblingElement("attr")) {
    if (attribute(*child, "key") == key) {
      const char* text = child->GetText();
      return text == nullptr ? std::string() : text;
    }
  }
  return {};
}

const XMLElement* childNode(const XMLElement& node, const std::string& name) {
  for (const XMLElement* child = node.FirstChildElement("node"); child != nullptr;
       child = child->NextSiblingElement("node")) {
    if (attribute(*child, "name") == name) {
      return child;
    }
  }
  return nullptr;
}

/// A whole number within 0..limit; nothing for any other text.
std::optional<int> wholeNumber(const std::string& text, int limit) {
  char* end = nullptr;
  const long value = std::strtol(text.c_str(), &end, 10);
  if (text.empty() || *end != '\0' || value < 0 || value > limit) {
    return std::nullopt;
  }
  return static_cast<int>(value);
}

std::optional<StreamKind> kindOf(const std::string& identifier) {
  if (identifier == kAedat4Events) {
    return StreamKind::kEvents;
  }
  if (identifier == kAedat4Frames) {
    return StreamKind::kFrames;
  }
  if (identifier == kAedat4Imu) {
    return StreamKind::kImu;
  }
  if (identifier == kAedat4Triggers) {
    return StreamKind::kTriggers;
  }
  return std::nullopt;
}

void readStream(const XMLElement& node, Aedat4Header& header) {
  const std::string number = attribute(node, "name");
  const std::optional<int> id = wholeNumber(number, std::numeric_limits<int>::max());
  const std::string identifier = valueOf(node, "typeIdentifier");
  const std::optional<StreamKind> kind = kindOf(identifier);
  if (!id || !kind) {
    header.faults.push_back("stream \"" + number + "\" holds \"" + identifier +
                            "\", expected EVTS, FRME, IMUS or TRIG: not read");
    return;
  }
  RecordedStream stream;
  stream.kind = *kind;
  stream.name = valueOf(node, "originalOutputName");
  if (const XMLElement* info = childNode(node, "info")) {
    stream.camera = valueOf(*info, "source");
    stream.size = {wholeNumber(valueOf(*info, "sizeX"), kAedat4MaxSide_px).value_or(0),
                   wholeNumber(valueOf(*info, "sizeY"), kAedat4MaxSide_px).value_or(0)};
  }
  header.streams[*id] = stream;
}

/// Coarse and fine value of one bias. Capitals differ between versions of DV.
std::optional<BiasSetting> biasOf(const XMLElement& node) {
  constexpr int kMaxCoarse = 7;
  constexpr int kMaxFine = 255;
  const std::optional<int> coarse = wholeNumber(valueOf(node, "coarseValue"), kMaxCoarse);
  const std::optional<int> fine = wholeNumber(valueOf(node, "fineValue"), kMaxFine);
  if (!coarse || !fine) {
    return std::nullopt;
  }
  return BiasSetting{*coarse, *fine};
}

/// The node that has the three biases of the thresholds as children, wherever it is in the tree.
class BiasSearch : public tinyxml2::XMLVisitor {
 public:
  bool VisitEnter(const XMLElement& element, const tinyxml2::XMLAttribute*) override {
    const XMLElement* diff = childNode(element, "DiffBn");
    const XMLElement* on = childNode(element, "OnBn");
    const XMLElement* off = childNode(element, "OffBn");
    if (!found_ && diff != nullptr && on != nullptr && off != nullptr) {
      const std::optional<BiasSetting> diff_setting = biasOf(*diff);
      const std::optional<BiasSetting> on_setting = biasOf(*on);
      const std::optional<BiasSetting> off_setting = biasOf(*off);
      if (diff_setting && on_setting && off_setting) {
        BiasConfiguration biases;
        biases.diff = *diff_setting;
        biases.on = *on_setting;
        biases.off = *off_setting;
        found_ = biases;
      }
    }
    return !found_;
  }
  const std::optional<BiasConfiguration>& found() const { return found_; }

 private:
  std::optional<BiasConfiguration> found_;
};

void readDescription(std::string_view xml, Aedat4Header& header) {
  tinyxml2::XMLDocument document;
  if (document.Parse(xml.data(), xml.size()) != tinyxml2::XML_SUCCESS) {
    header.faults.push_back(std::string("the description of the streams is no XML: ") +
                            document.ErrorName());
    return;
  }
  const XMLElement* root = document.FirstChildElement("dv");
  const XMLElement* info = root != nullptr ? childNode(*root, "outInfo") : nullptr;
  if (info == nullptr) {
    header.faults.emplace_back("the description of the streams has no node \"outInfo\"");
    return;
  }
  for (const XMLElement* node = info->FirstChildElement("node"); node != nullptr;
       node = node->NextSiblingElement("node")) {
    readStream(*node, header);
  }
  BiasSearch search;
  document.Accept(&search);
  header.biases = search.found();
}

/// Events of a camera whose size is left out are as large as its frames.
void completeSizes(Aedat4Header& header) {
  for (auto& entry : header.streams) {
    RecordedStream& stream = entry.second;
    if (stream.kind != StreamKind::kEvents || stream.size.pixelCount() > 0) {
      continue;
    }
    const auto frames =
        std::find_if(header.streams.begin(), header.streams.end(), [&stream](const auto& other) {
          return other.second.kind == StreamKind::kFrames && other.second.camera == stream.camera;
        });
    if (frames != header.streams.end()) {
      stream.size = frames->second.size;
    }
  }
}

}  // namespace

std::string decodeAedat4Header(FlatBytes io_header, Aedat4Header& header) {
  const std::optional<FlatTable> table = FlatTable::root(io_header, kAedat4Header);
  if (!table) {
    return "expected a header with the identifier IOHE";
  }
  const auto compression = table->number<std::int32_t>(kHeaderCompression, 0);
  switch (compression) {  // fast and high compression of each library have one format
    case 0:
      header.compression = Compression::kNone;
      break;
    case 1:
    case 2:
      header.compression = Compression::kLz4;
      break;
    case 3:
    case 4:
      header.compression = Compression::kZstd;
      break;
    default:
      return "compression " + std::to_string(compression) +
             ", expected 0 (none), 1 or 2 (LZ4), 3 or 4 (ZSTD)";
  }
  readDescription(table->text(kHeaderInfo), header);
  completeSizes(header);
  return {};
}

Aedat4Header readAedat4Header(const ByteSource& file, const std::string& path) {
  const auto fail = [&path](std::uint64_t offset, const std::string& what) {
    throw RecordingError(path + ", byte " + std::to_string(offset) + ": " + what);
  };
  std::vector<std::uint8_t> scratch;
  const std::uint8_t* bytes = file.read(0, kMagicBytes + sizeof(std::uint32_t), scratch);
  if (bytes == nullptr || std::memcmp(bytes, Aedat4Reader::kMagic, kMagicBytes) != 0) {
    fail(0, "expected \"#!AER-DAT4.0\" and a header");
  }
  std::uint32_t size = 0;
  std::memcpy(&size, bytes + kMagicBytes, sizeof(size));
  const std::uint64_t header_end = kMagicBytes + sizeof(size) + std::uint64_t{size};
  if (size > kMaxIoHeaderBytes || header_end > file.size()) {
    fail(kMagicBytes, "a header of " + std::to_string(size) + " bytes, expected at most " +
                          std::to_string(file.size() - kMagicBytes - sizeof(size)) +
                          ", to the end of the file");
  }
  bytes = file.read(kMagicBytes, sizeof(size) + size, scratch);
  const FlatBytes io_header = {bytes, bytes == nullptr ? 0 : sizeof(size) + size};
  Aedat4Header header;
  header.first_packet = header_end;
  const std::string fault = decodeAedat4Header(io_header, header);
  if (!fault.empty()) {
    fail(kMagicBytes, fault);
  }
  const std::optional<FlatTable> table = FlatTable::root(io_header, kAedat4Header);
  const auto data_table = table->number<std::int64_t>(kHeaderDataTable, -1);
  if (data_table > 0 && static_cast<std::uint64_t>(data_table) >= header_end &&
      static_cast<std::uint64_t>(data_table) < file.size()) {
    header.data_table = static_cast<std::uint64_t>(data_table);
  } else if (data_table > 0) {
    header.faults.push_back("the data table is said to be at byte " + std::to_string(data_table) +
                            " of " + std::to_string(file.size()) + ": the file is cut");
  }
  return header;
}

std::optional<std::vector<Aedat4TableEntry>> readAedat4Table(const ByteSource& file,
                                                             const Aedat4Header& header,
                                                             Decompressor& decompressor) {
  std::vector<Aedat4TableEntry> entries;
  const std::uint64_t offset = *header.data_table;
  const std::uint64_t size = file.size() - offset;
  std::vector<std::uint8_t> scratch;
  const std::uint8_t* bytes =
      size > kMaxTableBytes ? nullptr : file.read(offset, static_cast<std::size_t>(size), scratch);
  if (bytes == nullptr) {
    return std::nullopt;
  }
  RawBytes plain;
  if (!decompressor
           .run(header.compression, bytes, static_cast<std::size_t>(size), kMaxTableBytes, plain)
           .empty()) {
    return std::nullopt;
  }
  const std::optional<FlatTable> table =
      FlatTable::root({plain.data(), plain.size()}, kAedat4Table);
  const FlatVector rows =
      table ? table->vector(kTableEntries, sizeof(std::uint32_t)) : FlatVector{nullptr, 0, false};
  if (!rows.complete) {
    return std::nullopt;
  }
  const std::size_t count = rows.count;
  entries.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::optional<FlatTable> row = table->element(kTableEntries, i);
    const std::uint8_t* packet =
        row ? row->structure(kEntryPacket, kAedat4PacketHeaderBytes) : nullptr;
    if (packet == nullptr) {
      return std::nullopt;
    }
    Aedat4TableEntry entry;
    std::memcpy(&entry.stream, packet, sizeof(entry.stream));
    std::memcpy(&entry.size, packet + sizeof(entry.stream), sizeof(entry.size));
    entry.offset = row->number<std::uint64_t>(kEntryOffset, 0);
    entry.end_us = row->number<std::int64_t>(kEntryEnd, 0);
    if (entry.offset < header.first_packet + kAedat4PacketHeaderBytes || entry.offset > offset ||
        entry.size > offset - entry.offset) {
      return std::nullopt;
    }
    entries.push_back(entry);
  }
  return entries;
}

}  // namespace fast_edi
