#include "zip/zip_archive.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <utility>
#include <vector>

#include <zip.h>

#include "fast_edi/recording/recording_error.hpp"

namespace fast_edi {
namespace {

namespace fs = std::filesystem;

/// No recording becomes smaller; deflate reaches 1032.
constexpr std::uint64_t kMaxExpansion = 200;
/// A member may have so many bytes in any case.
constexpr std::uint64_t kAnyMemberHas = std::uint64_t{64} << 20;
constexpr std::size_t kTailBlockBytes = std::size_t{1} << 16;
constexpr zip_int64_t kMaxMembers = 10'000'000;

struct CloseArchive {
  void operator()(zip_t* archive) const { zip_discard(archive); }
};
struct CloseMember {
  void operator()(zip_file_t* member) const { zip_fclose(member); }
};
using ArchiveHandle = std::shared_ptr<zip_t>;
using MemberHandle = std::unique_ptr<zip_file_t, CloseMember>;

class MemberStream : public ByteStream {
 public:
  MemberStream(ArchiveHandle archive, MemberHandle member, std::uint64_t size)
      : archive_(std::move(archive)), member_(std::move(member)), size_(size) {}

  std::uint64_t size() const override { return size_; }

  std::size_t read(std::uint8_t* data, std::size_t count) override {
    std::size_t found = 0;
    while (found < count && fault_.empty() && !ended_) {
      const std::uint64_t left = size_ - place_;
      if (left == 0) {
        checkEnd();
        break;
      }
      const zip_int64_t read =
          zip_fread(member_.get(), data + found, std::min<std::uint64_t>(count - found, left));
      if (read <= 0) {
        noteFault(read);
        break;
      }
      found += static_cast<std::size_t>(read);
      place_ += static_cast<std::uint64_t>(read);
    }
    return found;
  }

  std::string fault() const override { return fault_; }

 private:
  /// Behind the last byte libzip compares the checksum.
  void checkEnd() {
    ended_ = true;
    std::uint8_t beyond = 0;
    const zip_int64_t read = zip_fread(member_.get(), &beyond, 1);
    if (read != 0) {
      noteFault(read);
    }
  }

  void noteFault(zip_int64_t read) {
    if (read > 0) {
      fault_ = "it holds more than the " + std::to_string(size_) + " bytes that the archive states";
    } else {
      const std::string reason =
          read < 0 ? zip_file_strerror(member_.get()) : std::string("it ends there");
      fault_ = "expected " + std::to_string(size_) + " bytes, damaged behind " +
               std::to_string(place_) + " (" + reason + ")";
    }
  }

  ArchiveHandle archive_;  ///< must outlive the member
  MemberHandle member_;
  const std::uint64_t size_;
  std::uint64_t place_ = 0;
  bool ended_ = false;
  std::string fault_;
};

class ZipArchive : public FileSet {
 public:
  explicit ZipArchive(const std::string& path) : path_(path) {
    int code = 0;
    archive_ = ArchiveHandle(zip_open(path.c_str(), ZIP_RDONLY, &code), CloseArchive());
    if (!archive_) {
      zip_error_t error;
      zip_error_init_with_code(&error, code);
      const std::string reason = zip_error_strerror(&error);
      zip_error_fini(&error);
      throw RecordingError(path + " cannot be opened as a zip archive (" + reason + ")");
    }
    listMembers();
  }

  bool has(const std::string& name) const override { return members_.count(normal(name)) > 0; }

  std::unique_ptr<ByteStream> open(const std::string& name) const override {
    const auto member = members_.find(normal(name));
    if (member == members_.end()) {
      throw RecordingError(pathOf(name) + " is not in the archive");
    }
    zip_stat_t stat = {};
    if (zip_stat_index(archive_.get(), member->second, 0, &stat) != 0) {
      throw RecordingError(pathOf(name) + ": " + zip_strerror(archive_.get()));
    }
    checkMember(name, stat);
    MemberHandle opened(zip_fopen_index(archive_.get(), member->second, 0));
    if (!opened) {
      throw RecordingError(pathOf(name) + ": " + zip_strerror(archive_.get()));
    }
    return std::make_unique<MemberStream>(archive_, std::move(opened), stat.size);
  }

  std::vector<std::string> list(const std::string& folder) const override {
    std::vector<std::string> names;
    const std::string before = folder + "/";
    for (auto member = members_.lower_bound(before);
         member != members_.end() && member->first.compare(0, before.size(), before) == 0;
         ++member) {
      if (member->first.find('/', before.size()) == std::string::npos) {
        names.push_back(member->first);
      }
    }
    return names;
  }

  /// Decompresses all of it.
  std::string tail(const std::string& name, std::size_t count) const override {
    const std::unique_ptr<ByteStream> stream = open(name);
    std::vector<std::uint8_t> block(std::max(count, kTailBlockBytes));
    std::string kept;
    for (;;) {
      const std::size_t found = stream->read(block.data(), block.size());
      if (found == 0) {
        return kept;
      }
      kept.append(block.begin(), block.begin() + static_cast<std::ptrdiff_t>(found));
      kept.erase(0, kept.size() - std::min(kept.size(), count));
    }
  }

  std::string pathOf(const std::string& name) const override {
    return name.empty() ? path_ : path_ + ", " + name;
  }

 private:
  static std::string normal(const std::string& name) {
    return fs::path(name).lexically_normal().string();
  }

  void listMembers() {
    const zip_int64_t count = zip_get_num_entries(archive_.get(), 0);
    if (count > kMaxMembers) {
      throw RecordingError(path_ + " has " + std::to_string(count) + " members, expected at most " +
                           std::to_string(kMaxMembers));
    }
    std::map<std::string, zip_uint64_t> members;
    for (zip_int64_t i = 0; i < count; ++i) {
      const char* name = zip_get_name(archive_.get(), static_cast<zip_uint64_t>(i), 0);
      // Folders are members of no bytes; what a Mac adds is none of the recording.
      const std::string text = name == nullptr ? "" : normal(name);
      if (!text.empty() && text.back() != '/' && text.rfind("__MACOSX/", 0) != 0) {
        members.emplace(text, static_cast<zip_uint64_t>(i));
      }
    }
    const std::string folder = commonFolder(members);
    for (const auto& [name, index] : members) {
      members_.emplace(name.substr(folder.size()), index);
    }
  }

  /// With a slash at its end; empty when members lie in several.
  static std::string commonFolder(const std::map<std::string, zip_uint64_t>& members) {
    if (members.empty()) {
      return {};
    }
    const std::string& first = members.begin()->first;
    const std::string folder = first.substr(0, first.find('/') + 1);
    const bool common = std::all_of(members.begin(), members.end(), [&](const auto& member) {
      return member.first.compare(0, folder.size(), folder) == 0;
    });
    return common ? folder : std::string();
  }

  void checkMember(const std::string& name, const zip_stat_t& stat) const {
    constexpr zip_uint64_t kNeeded =
        ZIP_STAT_SIZE | ZIP_STAT_COMP_SIZE | ZIP_STAT_COMP_METHOD | ZIP_STAT_ENCRYPTION_METHOD;
    if ((stat.valid & kNeeded) != kNeeded) {
      throw RecordingError(pathOf(name) + ": the archive does not state its size");
    }
    if (stat.encryption_method != ZIP_EM_NONE) {
      throw RecordingError(pathOf(name) + " is encrypted, expected it without a password");
    }
    if (stat.comp_method != ZIP_CM_STORE && stat.comp_method != ZIP_CM_DEFLATE) {
      throw RecordingError(pathOf(name) + " is compressed by the method " +
                           std::to_string(stat.comp_method) + ", expected deflate (8) or none (0)");
    }
    if (stat.size > kAnyMemberHas && stat.size / kMaxExpansion > stat.comp_size) {
      throw RecordingError(pathOf(name) + " states " + std::to_string(stat.size) +
                           " bytes, compressed to " + std::to_string(stat.comp_size) +
                           ", expected at most " + std::to_string(kMaxExpansion) +
                           " times as many");
    }
  }

  const std::string path_;
  ArchiveHandle archive_;
  std::map<std::string, zip_uint64_t> members_;  ///< and their places in the archive
};

}  // namespace

std::unique_ptr<FileSet> openZip(const std::string& path) {
  return std::make_unique<ZipArchive>(path);
}

}  // namespace fast_edi
