#include "recording/file_set.hpp"

#include <algorithm>
#include <cstring>
#include <filesystem>

#include "fast_edi/recording/byte_source.hpp"

namespace fast_edi {
namespace {

namespace fs = std::filesystem;

class FileStream : public ByteStream {
 public:
  explicit FileStream(const std::string& path) : file_(path) {}

  std::uint64_t size() const override { return file_.size(); }
  std::size_t read(std::uint8_t* data, std::size_t count) override {
    const auto there =
        static_cast<std::size_t>(std::min<std::uint64_t>(count, file_.size() - place_));
    if (there == 0) {
      return 0;
    }
    const std::uint8_t* bytes = file_.read(place_, there, scratch_);
    if (bytes == nullptr) {
      fault_ = "it cannot be read from byte " + std::to_string(place_) + " on";
      return 0;
    }
    std::memcpy(data, bytes, there);
    place_ += there;
    return there;
  }
  std::string fault() const override { return fault_; }

 private:
  FileSource file_;
  std::vector<std::uint8_t> scratch_;
  std::uint64_t place_ = 0;
  std::string fault_;
};

class Folder : public FileSet {
 public:
  explicit Folder(std::string path) : path_(std::move(path)) {}

  bool has(const std::string& name) const override {
    std::error_code ignored;  // what does not exist is no file
    return fs::is_regular_file(fs::path(path_) / name, ignored);
  }
  std::unique_ptr<ByteStream> open(const std::string& name) const override {
    return openStream(pathOf(name));
  }
  std::vector<std::string> list(const std::string& folder) const override {
    std::vector<std::string> names;
    std::error_code ignored;  // of no folder nothing is listed
    for (const fs::directory_entry& entry : fs::directory_iterator(pathOf(folder), ignored)) {
      names.push_back((fs::path(folder) / entry.path().filename()).string());
    }
    return names;
  }
  std::string tail(const std::string& name, std::size_t count) const override {
    const FileSource file(pathOf(name));
    const auto bytes = static_cast<std::size_t>(std::min<std::uint64_t>(file.size(), count));
    std::vector<std::uint8_t> scratch;
    const std::uint8_t* data = file.read(file.size() - bytes, bytes, scratch);
    return data == nullptr ? std::string() : std::string(data, data + bytes);
  }
  std::string pathOf(const std::string& name) const override {
    return name.empty() ? path_ : (fs::path(path_) / name).string();
  }

 private:
  const std::string path_;
};

}  // namespace

std::unique_ptr<ByteStream> openStream(const std::string& path) {
  return std::make_unique<FileStream>(path);
}

std::unique_ptr<FileSet> openFolder(const std::string& path) {
  return std::make_unique<Folder>(path);
}

}  // namespace fast_edi
