#include "recording/rosbag2_messages.hpp"

#include <filesystem>
#include <system_error>

#include "fast_edi/recording/recording_error.hpp"
#include "recording/damage_notes.hpp"
#include "recording/file_decompression.hpp"

namespace fast_edi {
namespace {

/// What position() is at the end of each file.
constexpr double kStepsPerFile = 1'000'000.0;

}  // namespace

Rosbag2Messages::Rosbag2Messages(const std::string& path) : files_(findRosbag2Files(path)) {
  for (const std::string& fault : files_.faults) {
    noteDamage(damage_, {0, fault});
  }
  if (!openFile()) {
    throw RecordingError(path + ": none of its " + std::to_string(files_.paths.size()) +
                         " files can be read; " + damage_.back().what);
  }
  readHeads();
  first_notes_ = damage_.size();
}

void Rosbag2Messages::readHeads() {
  topics_ = files_.topics;
  const auto add_topics = [this](const Rosbag2Storage& storage) {
    topics_.insert(topics_.end(), storage.topics().begin(), storage.topics().end());
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
        continue;  // noted once next() has come to it
      }
    }
  }
}

std::uint64_t Rosbag2Messages::position() const {
  const double of_file = file_ ? file_->storage().progress() : 0.0;
  return static_cast<std::uint64_t>((static_cast<double>(file_index_) + of_file) * kStepsPerFile);
}

std::uint64_t Rosbag2Messages::length() const {
  return static_cast<std::uint64_t>(static_cast<double>(files_.paths.size()) * kStepsPerFile);
}

/// The first file from file_index_ on that can be read, unless one is open.
/// \return false when there is none
bool Rosbag2Messages::openFile() {
  while (!file_ && file_index_ < files_.paths.size()) {
    const std::string& path = files_.paths[file_index_];
    try {
      file_ = std::make_unique<Rosbag2File>(path);
    } catch (const RecordingError& error) {
      if (files_.paths.size() == 1) {
        throw;
      }
      noteDamage(damage_, {0, error.what()});
      ++file_index_;
      continue;
    }
    copied_notes_ = 0;
    if (!file_->fault().empty()) {
      noteDamage(damage_, {0, fileName() + file_->fault()});
    }
  }
  return file_ != nullptr;
}

void Rosbag2Messages::copyNotes() {
  const std::vector<RecordingDamage>& notes = file_->storage().damage();
  for (; copied_notes_ < notes.size(); ++copied_notes_) {
    noteDamage(damage_, {notes[copied_notes_].offset, fileName() + notes[copied_notes_].what});
  }
}

bool Rosbag2Messages::next(Rosbag2Message& message) {
  while (openFile()) {
    const bool found = file_->storage().next(message);
    copyNotes();
    if (found) {
      ++count_;
      return true;
    }
    file_.reset();
    ++file_index_;
  }
  if (files_.messages.value_or(count_) > count_ && !noted_missing_) {
    noted_missing_ = true;
    noteDamage(damage_, {0, std::to_string(count_) + " messages are found, expected " +
                                std::to_string(*files_.messages)});
  }
  return false;
}

bool Rosbag2Messages::peek(Rosbag2Message& message) {
  return file_->storage().next(message);
}

void Rosbag2Messages::rewind() {
  damage_.resize(first_notes_);
  file_->storage().rewind();
}

bool Rosbag2Messages::uncompress(Rosbag2Message& message) {
  if (!beginsWithZstd(message.data, message.size)) {
    return true;
  }
  const std::string fault = decompressor_.run(Compression::kZstd, message.data, message.size,
                                              Rosbag2Storage::kMaxMessageBytes, uncompressed_);
  if (!fault.empty()) {
    note(message, fault);
  }
  message.data = uncompressed_.data();
  message.size = uncompressed_.size();
  return !uncompressed_.empty();
}

void Rosbag2Messages::note(const Rosbag2Message& message, const std::string& what) {
  noteDamage(damage_, {message.offset, fileName() + topicOf(message).name + ": " + what});
}

/// Of the file that is open, for notes where there are several.
std::string Rosbag2Messages::fileName() const {
  if (files_.paths.size() == 1) {
    return {};
  }
  const std::string& path = file_->path();
  return path.substr(path.rfind('/') + 1) + ": ";
}

}  // namespace fast_edi
