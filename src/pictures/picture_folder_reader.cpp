#include "fast_edi/pictures/picture_folder_reader.hpp"

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "fast_edi/recording/recording_error.hpp"
#include "pictures/event_text.hpp"
#include "pictures/frame_list.hpp"
#include "pictures/picture.hpp"
#include "recording/file_set.hpp"
#include "recording/merged_recording.hpp"
#include "zip/zip_archive.hpp"

namespace fast_edi {
namespace {

/// Events that are read at once.
constexpr std::size_t kBlockEvents = 20'000;
/// Of a picture's file; kMaxPicturePixels with four channels of 16 bits.
constexpr std::uint64_t kMaxPictureBytes = kMaxPicturePixels * 8;

std::optional<Picture> readPicture(const FileSet& files, const std::string& name,
                                   std::string& fault) {
  try {
    const std::unique_ptr<ByteStream> file = files.open(name);
    if (file->size() > kMaxPictureBytes) {
      fault = "a file of " + std::to_string(file->size()) + " bytes, expected a picture";
      return std::nullopt;
    }
    std::vector<std::uint8_t> bytes(static_cast<std::size_t>(file->size()));
    const std::size_t found = file->read(bytes.data(), bytes.size());
    if (found < bytes.size()) {
      fault = file->fault();
      return std::nullopt;
    }
    return decodePicture(bytes.data(), bytes.size(), fault);
  } catch (const RecordingError& error) {
    fault = error.what();
    return std::nullopt;
  }
}

class PictureReader : public MergedRecording {
 public:
  PictureReader(std::unique_ptr<FileSet> files, std::string format)
      : files_(std::move(files)), format_(std::move(format)) {
    FrameList list = readFrameList(*files_);
    frames_ = std::move(list.frames);
    for (RecordingDamage& place : list.damage) {
      note(std::move(place));
    }
    std::string fault;
    std::optional<Picture> first;
    for (std::size_t i = 0; i < frames_.size() && !first; ++i) {
      first = readPicture(*files_, frames_[i].name, fault);
    }
    if (!first) {
      throw RecordingError(frames_.empty() ? files_->pathOf("") + ": no frame has a usable time"
                                           : files_->pathOf(frames_.front().name) + ": " + fault);
    }
    std::vector<FrameTime> times;
    std::vector<std::int64_t> stamps;
    times.reserve(frames_.size());
    stamps.reserve(frames_.size());
    for (const ListedFrame& frame : frames_) {
      times.push_back(frame.time);
      stamps.push_back(frame.time.stamp_ns);
    }
    addFrames(std::move(times), first->size);
    const std::string events = eventTextOf(*files_);
    if (!events.empty()) {
      events_.emplace(*files_, events, first->size, stamps);
      addEvents(first->size);
    }
  }

  std::string format() const override { return format_; }
  std::uint64_t position() const override {
    return framesRead() + (events_ ? events_->position() : 0);
  }
  std::uint64_t length() const override { return frames_.size() + fileSize(); }
  std::uint64_t fileSize() const override { return events_ ? events_->size() : 0; }

 private:
  bool readFrame(std::size_t index, RecordedFrame& frame) override {
    const ListedFrame& listed = frames_[index];
    std::string fault;
    picture_ = readPicture(*files_, listed.name, fault);
    if (!picture_) {
      note({0, "of " + files_->pathOf(listed.name) + ": " + fault});
      return false;
    }
    frame.size = picture_->size;
    frame.encoding = picture_->encoding;
    frame.pixels = picture_->pixels.data();
    frame.bytes = picture_->pixels.size();
    return true;
  }

  void readEvents(EventBlock& block) override {
    Event event;
    while (block.events.size() < kBlockEvents && events_->next(event)) {
      block.events.push_back(event);
    }
    for (RecordingDamage& place : events_->takeDamage()) {
      note(std::move(place));
    }
  }

  const std::unique_ptr<FileSet> files_;
  const std::string format_;
  std::vector<ListedFrame> frames_;
  std::optional<EventTextReader> events_;
  std::optional<Picture> picture_;
};

}  // namespace

std::unique_ptr<Recording> openPictureFolder(const std::string& path) {
  return std::make_unique<PictureReader>(openFolder(path), "pictures and text");
}

std::unique_ptr<Recording> openPictureArchive(const std::string& path) {
  std::unique_ptr<FileSet> files = openZip(path);
  if (!hasFrameList(*files)) {
    throw RecordingError(path +
                         " is a zip archive, but no recording: expected images.txt, frames.csv or "
                         "Exposure_start.txt in it");
  }
  return std::make_unique<PictureReader>(std::move(files), "pictures and text, zip");
}

}  // namespace fast_edi
