#include "stream/served_stream.hpp"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "fast_edi/recording/aedat4_reader.hpp"
#include "fast_edi/recording/byte_source.hpp"
#include "recording/aedat4_header.hpp"
#include "recording/number_at.hpp"

namespace fast_edi::testing {
namespace {

std::string newFolder() {
  std::string pattern = (std::filesystem::temp_directory_path() / "served_XXXXXX").string();
  if (::mkdtemp(pattern.data()) == nullptr) {
    throw std::runtime_error("cannot make a directory like " + pattern);
  }
  return pattern;
}

std::string fileIn(const std::string& folder) {
  return folder + "/stream.aedat4";
}

}  // namespace

std::string ServedStream::all() const {
  std::string bytes = header;
  for (const std::string& packet : packets) {
    bytes += packet;
  }
  return bytes;
}

StreamBytes::StreamBytes(const RecordedStream& stream, Aedat4Compression compression)
    : folder_(newFolder()), writer_(fileIn(folder_), {stream}, compression, true) {}

void StreamBytes::add(const std::vector<Event>& events) {
  RecordingItem item;
  item.content = RecordedEvents{events.data(), events.size()};
  writer_.write(item);
}

void StreamBytes::add(const RecordedFrame& frame) {
  RecordingItem item;
  item.content = frame;
  writer_.write(item);
}

void StreamBytes::add(const RecordedImu& sample) {
  RecordingItem item;
  item.content = sample;
  writer_.write(item);
}

void StreamBytes::add(const RecordedTrigger& trigger) {
  RecordingItem item;
  item.content = trigger;
  writer_.write(item);
}

ServedStream StreamBytes::take() {
  writer_.close();
  const std::string path = fileIn(folder_);
  const Aedat4Header header = readAedat4Header(FileSource(path), path);
  std::ifstream file(path, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  std::filesystem::remove_all(folder_);
  const std::size_t magic_bytes = sizeof(Aedat4Reader::kMagic) - 1;
  ServedStream served;
  served.header = bytes.substr(magic_bytes, header.first_packet - magic_bytes);
  for (std::size_t place = header.first_packet; place < header.data_table.value();) {
    const auto* size = reinterpret_cast<const std::uint8_t*>(bytes.data()) + place + 4;
    const std::size_t packet_bytes = kAedat4PacketHeaderBytes + numberAt<std::uint32_t>(size);
    served.packets.push_back(bytes.substr(place, packet_bytes));
    place += packet_bytes;
  }
  return served;
}

}  // namespace fast_edi::testing
