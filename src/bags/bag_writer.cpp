#include "fast_edi/bags/bag_writer.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>

#include <ros/message_traits.h>
#include <ros/serialization.h>

#include "fast_edi/bags/bag_error.hpp"

namespace fast_edi {

/// A message that rosbag copies without looking into it.
struct RawMessage {
  const BagMessage& message;
};

}  // namespace fast_edi

namespace ros {
namespace message_traits {

template <>
struct MD5Sum<fast_edi::RawMessage> {
  static const char* value(const fast_edi::RawMessage& raw) {
    return raw.message.connection->md5sum.c_str();
  }
};
template <>
struct DataType<fast_edi::RawMessage> {
  static const char* value(const fast_edi::RawMessage& raw) {
    return raw.message.connection->datatype.c_str();
  }
};
template <>
struct Definition<fast_edi::RawMessage> {
  static const char* value(const fast_edi::RawMessage& raw) {
    return raw.message.connection->definition.c_str();
  }
};

}  // namespace message_traits

namespace serialization {

template <>
struct Serializer<fast_edi::RawMessage> {
  template <typename Stream>
  static void write(Stream& stream, const fast_edi::RawMessage& raw) {
    if (raw.message.size > 0) {
      std::memcpy(stream.advance(raw.message.size), raw.message.data, raw.message.size);
    }
  }
  static std::uint32_t serializedLength(const fast_edi::RawMessage& raw) {
    return raw.message.size;
  }
};

}  // namespace serialization
}  // namespace ros

namespace fast_edi {
namespace {

namespace fs = std::filesystem;

constexpr mode_t kNewFileMode = 0666;

rosbag::CompressionType compressionType(const std::string& name) {
  if (name == "bz2") {
    return rosbag::compression::BZ2;
  }
  return name == "lz4" ? rosbag::compression::LZ4 : rosbag::compression::Uncompressed;
}

bool sameFile(const std::string& a, const std::string& b) {
  std::error_code ignored;  // one that does not exist is not the same
  return fs::equivalent(a, b, ignored);
}

/// Says why a file cannot be written, which rosbag does not.
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
  bag_ = std::make_unique<rosbag::Bag>();
  guarded([&] {
    bag_->open(active_path_, rosbag::bagmode::Write);
    bag_->setCompression(compressionType(compression));
  });
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
}

void BagWriter::claim() {
  if (!lock_.take(active_path_)) {
    throw BagError("cannot write " + path_ + ": another process is writing " + active_path_);
  }
}

BagWriter::~BagWriter() {
  if (bag_) {
    try {
      bag_->close();
    } catch (const std::exception&) {
      // Somebody else's error is on its way already. rosbag's destructor would try again, throw
      // and so end the program: it must not run.
      static_cast<void>(bag_.release());
    }
  }
  if (lock_.isHeld()) {
    std::error_code ignored;
    fs::remove(active_path_, ignored);
  }
}

void BagWriter::copy(const BagMessage& message) {
  guarded([&] {
    bag_->write(message.connection->topic, writableTime(message.time), RawMessage{message},
                message.connection->header);
  });
}

void BagWriter::close() {
  guarded([&] { bag_->close(); });
  bag_.reset();
  std::error_code error;
  fs::rename(active_path_, path_, error);
  if (error) {
    throw BagError("cannot rename " + active_path_ + " to " + path_ + ": " + error.message());
  }
  lock_.release();
}

void BagWriter::fail(const std::exception& error) {
  const int cause = errno;
  // As in the destructor: closing would throw again.
  static_cast<void>(bag_.release());
  std::string what = "cannot write " + active_path_ + ": " + error.what();
  if (cause != 0) {
    what += std::string(" (") + std::strerror(cause) + ")";
  }
  throw BagError(what + (unfinished_ == UnfinishedBag::kRemove
                             ? "; what was written so far is removed"
                             : "; what was written so far is left there, without an index"));
}

}  // namespace fast_edi
