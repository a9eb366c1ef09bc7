#include "recording/rosbag2_files.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstring>
#include <filesystem>
#include <string_view>

#include <yaml-cpp/yaml.h>

#include "fast_edi/recording/recording_error.hpp"
#include "recording/file_decompression.hpp"
#include "recording/mcap_storage.hpp"
#include "recording/sqlite_storage.hpp"

namespace fast_edi {
namespace {

namespace fs = std::filesystem;

constexpr char kMetadata[] = "metadata.yaml";
constexpr char kRoot[] = "rosbag2_bagfile_information";
constexpr std::array<std::string_view, 5> kExtensions = {".db3", ".mcap", ".db3.zstd", ".mcap.zstd",
                                                         ".zstd"};
constexpr std::uint64_t kMaxMetadataBytes = std::uint64_t{4} << 20;
/// Far deeper than metadata are.
constexpr int kMaxDepth = 100;
constexpr std::size_t kMaxFiles = 100'000;

bool endsWith(std::string_view text, std::string_view end) {
  return text.size() >= end.size() && text.substr(text.size() - end.size()) == end;
}

bool isStorageName(const fs::path& path) {
  const std::string name = path.filename().string();
  return std::any_of(kExtensions.begin(), kExtensions.end(),
                     [&](std::string_view extension) { return endsWith(name, extension); });
}

/// Numbers within names by their value: NAME_2 comes before NAME_10.
bool comesBefore(const std::string& a, const std::string& b) {
  const auto is_digit = [](char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; };
  const auto number_at = [&](const std::string& text, std::size_t& place) {
    const std::size_t begin = std::min(text.find_first_not_of('0', place), text.size());
    place = static_cast<std::size_t>(
        std::find_if_not(text.begin() + static_cast<std::ptrdiff_t>(begin), text.end(), is_digit) -
        text.begin());
    return std::string_view(text).substr(begin, place - begin);
  };
  std::size_t i = 0;
  std::size_t j = 0;
  while (i < a.size() && j < b.size()) {
    if (is_digit(a[i]) && is_digit(b[j])) {
      const std::string_view of_a = number_at(a, i);
      const std::string_view of_b = number_at(b, j);
      if (of_a != of_b) {
        return of_a.size() != of_b.size() ? of_a.size() < of_b.size() : of_a < of_b;
      }
    } else if (a[i] != b[j]) {
      return a[i] < b[j];
    } else {
      ++i;
      ++j;
    }
  }
  return a.size() - i < b.size() - j;
}

std::vector<std::string> storageFilesIn(const fs::path& folder) {
  std::vector<std::string> paths;
  std::error_code failed;
  for (fs::directory_iterator entry(folder, failed), end; !failed && entry != end;
       entry.increment(failed)) {
    std::error_code ignored;  // what cannot be asked is no file
    if (paths.size() < kMaxFiles && isStorageName(entry->path()) &&
        entry->is_regular_file(ignored)) {
      paths.push_back(entry->path().string());
    }
  }
  std::sort(paths.begin(), paths.end(), comesBefore);
  return paths;
}

/// Whether a YAML text is no deeper than a parser that calls itself stands.
bool isShallow(const std::string& text) {
  int brackets = 0;
  int in_line = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '\n') {
      in_line = 0;
    } else if (c == '[' || c == '{') {
      ++brackets;
    } else if (c == ']' || c == '}') {
      brackets = std::max(0, brackets - 1);
    } else if ((c == '-' || c == '?' || c == ':') && i + 1 < text.size() && text[i + 1] == ' ') {
      ++in_line;
    }
    if (brackets > kMaxDepth || in_line > 10 * kMaxDepth) {
      return false;
    }
  }
  return true;
}

/// Throws YAML::Exception where it contradicts itself.
void readMetadata(const std::string& text, const fs::path& folder, Rosbag2Files& files) {
  const YAML::Node root = YAML::Load(text)[kRoot];
  if (!root || !root.IsMap()) {
    files.faults.push_back(std::string(kMetadata) + ": expected " + kRoot);
    return;
  }
  if (const YAML::Node count = root["message_count"]) {
    files.messages = count.as<std::uint64_t>();
  }
  for (const YAML::Node& entry : root["topics_with_message_count"]) {
    const YAML::Node topic = entry["topic_metadata"];
    files.topics.push_back({topic["name"].as<std::string>(), topic["type"].as<std::string>(),
                            topic["serialization_format"].as<std::string>("cdr")});
  }
  for (const YAML::Node& entry : root["relative_file_paths"]) {
    // Early versions of rosbag2 have the folder in front; nothing else lies elsewhere.
    const fs::path name = fs::path(entry.as<std::string>()).filename();
    std::error_code ignored;  // what cannot be asked is not there
    if (files.paths.size() < kMaxFiles && fs::is_regular_file(folder / name, ignored)) {
      files.paths.push_back((folder / name).string());
    } else {
      files.faults.push_back(std::string(kMetadata) + " names the file " + name.string() +
                             ", which is missing");
    }
  }
}

bool hasMagic(const std::uint8_t* data, std::size_t size, std::string_view magic) {
  return size >= magic.size() && std::memcmp(data, magic.data(), magic.size()) == 0;
}

}  // namespace

bool isRosbag2Folder(const std::string& path) {
  return !storageFilesIn(path).empty();
}

Rosbag2Files findRosbag2Files(const std::string& path) {
  Rosbag2Files files;
  const bool is_folder = fs::is_directory(path);
  if (!is_folder && fs::path(path).filename() != kMetadata) {
    files.paths.push_back(path);
    return files;
  }
  const fs::path folder = is_folder ? fs::path(path) : fs::path(path).parent_path();
  const fs::path metadata = folder / kMetadata;
  if (fs::exists(metadata)) {
    const FileSource file(metadata.string());
    std::vector<std::uint8_t> bytes;
    const auto size = static_cast<std::size_t>(std::min(file.size(), kMaxMetadataBytes));
    std::string text;
    if (const std::uint8_t* data = file.read(0, size, bytes)) {
      text.assign(reinterpret_cast<const char*>(data), size);
    }
    try {
      if (isShallow(text)) {
        readMetadata(text, folder, files);
      } else {
        files.faults.push_back(std::string(kMetadata) + ": nested too deeply");
      }
    } catch (const YAML::Exception& error) {
      files.faults.push_back(std::string(kMetadata) + ", line " +
                             std::to_string(error.mark.line + 1) + ": " + error.msg);
    }
  }
  if (files.paths.empty()) {
    files.paths = storageFilesIn(folder);
  }
  if (files.paths.empty()) {
    throw RecordingError(folder.string() + ": no file of a rosbag2, expected *.db3 or *.mcap");
  }
  return files;
}

Rosbag2File::Rosbag2File(const std::string& path) : path_(path), file_(path) {
  constexpr std::size_t kLookedAt = 16;
  const ByteSource* source = &file_;
  std::vector<std::uint8_t> scratch;
  const auto begin_of = [&] {
    const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(kLookedAt, source->size()));
    const std::uint8_t* bytes = source->read(0, count, scratch);
    return std::pair(bytes, bytes == nullptr ? 0 : count);
  };
  auto [begin, count] = begin_of();
  if (beginsWithZstd(begin, count)) {
    decompressed_ = decompressFile(file_, fault_);
    source = decompressed_.get();
    std::tie(begin, count) = begin_of();
  }
  if (hasMagic(begin, count, McapStorage::kMagic)) {
    storage_ = std::make_unique<McapStorage>(*source, path);
    return;
  }
  if (!hasMagic(begin, count, SqliteStorage::kMagic)) {
    throw RecordingError(path + ", byte 0: expected the first bytes of SQLite or MCAP" +
                         (fault_.empty() ? "" : " when decompressed: " + fault_));
  }
  const std::string log = path + "-wal";
  std::error_code ignored;  // what cannot be asked is not there
  if (decompressed_ == nullptr && fs::is_regular_file(log, ignored) &&
      fs::file_size(log, ignored) > 0) {
    log_ = std::make_unique<FileSource>(log);
  }
  storage_ = std::make_unique<SqliteStorage>(*source, log_.get(), path);
}

}  // namespace fast_edi
