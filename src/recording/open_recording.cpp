#include "fast_edi/recording/open_recording.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>
#include <string_view>

#include "fast_edi/recording/aedat2_reader.hpp"
#include "fast_edi/recording/aedat3_reader.hpp"
#include "fast_edi/recording/aedat4_reader.hpp"
#include "fast_edi/recording/byte_source.hpp"
#include "fast_edi/recording/rosbag2_reader.hpp"
#include "recording/rosbag2_files.hpp"

namespace fast_edi {
namespace {

constexpr std::string_view kRosbagMagic = "#ROSBAG";
constexpr std::string_view kAedat4Magic = "#!AER-DAT4";
constexpr std::string_view kAedat2Magic = "#!AER-DAT2";
constexpr std::string_view kAedat3Magic = "#!AER-DAT3.1";
/// SQLite, MCAP, either compressed by ZSTD, and metadata.yaml.
constexpr std::array<std::string_view, 4> kRosbag2Magics = {
    "SQLite format 3", "\x89MCAP0\r\n", "\x28\xB5\x2F\xFD", "rosbag2_bagfile_information:"};

constexpr std::string_view kZipMagic = "PK\x03\x04";
constexpr std::string_view kHdf5Magic = "\x89HDF\r\n\x1a\n";
/// Where it may begin: behind a block that is a user's.
constexpr std::array<std::uint64_t, 4> kHdf5Offsets = {0, 512, 1024, 2048};

bool hasAt(const FileSource& file, std::uint64_t offset, std::string_view magic) {
  std::vector<std::uint8_t> scratch;
  const std::uint8_t* bytes = file.read(offset, magic.size(), scratch);
  return bytes != nullptr && std::memcmp(bytes, magic.data(), magic.size()) == 0;
}

bool beginsWith(const FileSource& file, std::string_view magic) {
  return hasAt(file, 0, magic);
}

}  // namespace

RecordingFormat formatOf(const std::string& path) {
  std::error_code ignored;  // FileSource says what is wrong
  if (std::filesystem::is_directory(path, ignored)) {
    return isRosbag2Folder(path) ? RecordingFormat::kRosbag2 : RecordingFormat::kUnknown;
  }
  const FileSource file(path);
  if (beginsWith(file, kRosbagMagic)) {
    return RecordingFormat::kRosbag;
  }
  if (beginsWith(file, kAedat2Magic)) {
    return RecordingFormat::kAedat2;
  }
  if (beginsWith(file, kAedat3Magic)) {
    return RecordingFormat::kAedat3;
  }
  for (const std::string_view magic : kRosbag2Magics) {
    if (beginsWith(file, magic)) {
      return RecordingFormat::kRosbag2;
    }
  }
  if (beginsWith(file, kAedat4Magic)) {
    return RecordingFormat::kAedat4;
  }
  if (beginsWith(file, kZipMagic)) {
    return RecordingFormat::kZip;
  }
  const bool hdf5 =
      std::any_of(kHdf5Offsets.begin(), kHdf5Offsets.end(),
                  [&file](std::uint64_t offset) { return hasAt(file, offset, kHdf5Magic); });
  return hdf5 ? RecordingFormat::kHdf5 : RecordingFormat::kUnknown;
}

std::unique_ptr<Recording> openRecording(const std::string& path) {
  switch (formatOf(path)) {
    case RecordingFormat::kAedat4:
      return std::make_unique<Aedat4Reader>(path);
    case RecordingFormat::kAedat2:
      return openAedat2(path);
    case RecordingFormat::kAedat3:
      return openAedat3(path);
    case RecordingFormat::kRosbag2:
      return openRosbag2(path);
    case RecordingFormat::kHdf5:
    case RecordingFormat::kZip:
    case RecordingFormat::kRosbag:
    case RecordingFormat::kUnknown:
      break;
  }
  return nullptr;
}

}  // namespace fast_edi
