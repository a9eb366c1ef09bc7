#include "fast_edi/bags/bag_writer.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "bags/bag_content.hpp"
#include "fast_edi/bags/bag_error.hpp"

namespace fast_edi {
namespace {

namespace fs = std::filesystem;

constexpr mode_t kNewFileMode = 0666;

bool sameFile(const std::string& a, const std::string& b) {
  std::error_code ignored;  // one that does not exist is not the same
  return fs::equivalent(a, b, ignored);
}

/// \throws BagError that says why it is not
void requireWritable(const std::string& path) {
  const int descriptor = ::open(path.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, kNewFileMode);
  if (descriptor < 0) {
    throw BagError("cannot write " + path + ": " + std::strerror(errno));
  }
  ::close(descriptor);
}

}  // namespace

BagWriter::BagWriter(const std::string& path, const std::vector<std::string>& inputs,
                     const std::string& compression, bool overwrite, UnfinishedBag unfinished)
    : path_(path), active_path_(path + ".active"), unfinished_(unfinished) {
  requireFree(inputs, overwrite);
  requireWritable(active_path_);
  if (unfinished_ == UnfinishedBag::kRemove) {
    claim();
  }
  try {
    guarded([&] { content_ = std::make_unique<BagContent>(active_path_, compression); });
  } catch (const BagError&) {
    removeUnfinished();
    throw;
  }
}

void BagWriter::requireFree(const std::vector<std::string>& inputs, bool overwrite) const {
  for (const std::string& output : {path_, active_path_}) {
    const bool may_exist =
        overwrite || (unfinished_ == UnfinishedBag::kRemove && output == active_path_);
    if (std::any_of(inputs.begin(), inputs.end(),
                    [&](const std::string& input) { return sameFile(output, input); })) {
      throw BagError("cannot write " + output + ": it is the input");
    }
    if (!may_exist && fs::exists(output)) {
      throw BagError("cannot write " + output + ": it exists already (--force replaces it)");
    }
    if (fs::is_directory(output)) {
      throw BagError("cannot write " + output + ": it is a directory");
    }
  }
  // A device or a pipe would give its name to the output.
  if (fs::exists(path_) && !fs::is_regular_file(path_)) {
    throw BagError("cannot write " + path_ + ": it is no regular file");
  }
}

void BagWriter::claim() {
  if (!lock_.take(active_path_)) {
    throw BagError("cannot write " + path_ + ": another process is writing " + active_path_);
  }
}

BagWriter::~BagWriter() {
  if (content_) {
    try {
      content_->close();
    } catch (const std::exception&) {
      // Somebody else's error is on its way already.
    }
  }
  removeUnfinished();
}

void BagWriter::removeUnfinished() {
  if (lock_.isHeld()) {
    std::error_code ignored;
    fs::remove(active_path_, ignored);
  }
}

void BagWriter::copyChunksOf(const ChunkSource& source) {
  content_->copyChunksOf(source);
}

void BagWriter::copy(const BagMessage& message) {
  guarded([&] { content_->copy(message); });
}

void BagWriter::writeBytes(const BagConnection& connection, const ros::Time& time) {
  guarded([&] {
    content_->write(connection, time, bytes_.data(), static_cast<std::uint32_t>(bytes_.size()));
  });
}

void BagWriter::close() {
  guarded([&] { content_->close(); });
  content_.reset();
  std::error_code error;
  fs::rename(active_path_, path_, error);
  if (error) {
    throw BagError("cannot rename " + active_path_ + " to " + path_ + ": " + error.message());
  }
  lock_.release();
}

template <typename Action>
void BagWriter::guarded(Action action) {
  try {
    action();
  } catch (const std::exception& error) {
    fail(error);
  }
}

void BagWriter::fail(const std::exception& error) {
  content_.reset();
  throw BagError("cannot write " + active_path_ + ": " + error.what() +
                 (unfinished_ == UnfinishedBag::kRemove
                      ? "; what was written so far is removed"
                      : "; what was written so far is left there, without an index"));
}

}  // namespace fast_edi
