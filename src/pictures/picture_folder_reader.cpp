#include "fast_edi/pictures/picture_folder_reader.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "fast_edi/recording/byte_source.hpp"
#include "fast_edi/recording/recording_error.hpp"
#include "pictures/event_text.hpp"
#include "pictures/frame_list.hpp"
#include "pictures/picture.hpp"

namespace fast_edi {
namespace {

/// An item spans no more.
constexpr std::int64_t kMaxItem_ns = 10 * kNanosecondsPerMillisecond;
// Streams, in this order.
constexpr std::size_t kFrames = 0;
constexpr std::size_t kEvents = 1;
constexpr char kCamera[] = "DAVIS";
/// Of a picture's file; kMaxPicturePixels with four channels of 16 bits.
constexpr std::uint64_t kMaxPictureBytes = kMaxPicturePixels * 8;

std::optional<Picture> readPicture(const std::string& path, std::string& fault) {
  try {
    const FileSource file(path);
    if (file.size() > kMaxPictureBytes) {
      fault = "a file of " + std::to_string(file.size()) + " bytes, expected a picture";
      return std::nullopt;
    }
    std::vector<std::uint8_t> bytes;
    if (file.read(0, static_cast<std::size_t>(file.size()), bytes) == nullptr) {
      fault = "it cannot be read";
      return std::nullopt;
    }
    return decodePicture(bytes.data(), bytes.size(), fault);
  } catch (const RecordingError& error) {
    fault = error.what();
    return std::nullopt;
  }
}

std::int64_t endOf(const ListedFrame& frame) {
  return frame.exposure ? frame.exposure->end_ns : frame.stamp_ns;
}

class PictureFolderReader : public Recording {
 public:
  explicit PictureFolderReader(const std::string& path) {
    FrameList list = readFrameList(path);
    frames_ = std::move(list.frames);
    damage_ = std::move(list.damage);
    std::string fault;
    std::optional<Picture> first;
    for (std::size_t i = 0; i < frames_.size() && !first; ++i) {
      first = readPicture(frames_[i].path, fault);
    }
    if (!first) {
      throw RecordingError(frames_.empty() ? path + ": no frame has a usable time"
                                           : frames_.front().path + ": " + fault);
    }
    streams_.push_back({StreamKind::kFrames, "frames", kCamera, first->size});
    const std::string events = eventTextOf(path);
    if (!events.empty()) {
      std::vector<std::int64_t> times;
      times.reserve(frames_.size());
      for (const ListedFrame& frame : frames_) {
        times.push_back(frame.stamp_ns);
      }
      events_.emplace(events, first->size, times);
      streams_.push_back({StreamKind::kEvents, "events", kCamera, first->size});
      advance();
    }
  }

  bool next(RecordingItem& item) override {
    while (frame_ < frames_.size() || waiting_) {
      const bool frame_is_due =
          frame_ < frames_.size() && (!waiting_ || waiting_->t_ns >= endOf(frames_[frame_]));
      if (frame_is_due ? giveFrame(item) : giveEvents(item)) {
        return true;
      }
    }
    return false;
  }

  std::string format() const override { return "pictures and text"; }
  const std::vector<RecordedStream>& streams() const override { return streams_; }
  const std::vector<RecordingDamage>& damage() const override { return damage_; }
  std::uint64_t position() const override { return frame_ + (events_ ? events_->position() : 0); }
  std::uint64_t length() const override { return frames_.size() + fileSize(); }
  std::uint64_t fileSize() const override { return events_ ? events_->size() : 0; }
  bool knowsExposures() const override {
    return std::all_of(frames_.begin(), frames_.end(),
                       [](const ListedFrame& frame) { return frame.exposure.has_value(); });
  }

 private:
  void advance() {
    Event event;
    waiting_ = events_->next(event) ? std::optional(event) : std::nullopt;
    for (RecordingDamage& place : events_->takeDamage()) {
      damage_.push_back(std::move(place));
    }
  }

  /// \return false for a picture that cannot be read
  bool giveFrame(RecordingItem& item) {
    const ListedFrame& listed = frames_[frame_++];
    std::string fault;
    picture_ = readPicture(listed.path, fault);
    if (!picture_) {
      damage_.push_back({0, "of " + listed.path + ": " + fault});
      return false;
    }
    RecordedFrame frame;
    frame.exposure = listed.exposure;
    frame.stamp_ns = listed.stamp_ns;
    frame.size = picture_->size;
    frame.encoding = picture_->encoding;
    frame.pixels = picture_->pixels.data();
    frame.bytes = picture_->pixels.size();
    record_ns_ = std::max(record_ns_, endOf(listed));
    item.stream = kFrames;
    item.record_ns = record_ns_;
    item.content = frame;
    return true;
  }

  bool giveEvents(RecordingItem& item) {
    const std::int64_t frame_ns =
        frame_ < frames_.size() ? endOf(frames_[frame_]) : std::numeric_limits<std::int64_t>::max();
    const std::int64_t first_ns = waiting_->t_ns;
    given_.clear();
    while (waiting_ && waiting_->t_ns < frame_ns && waiting_->t_ns < first_ns + kMaxItem_ns &&
           given_.size() < kMaxItemEvents) {
      given_.push_back(*waiting_);
      record_ns_ = std::max(record_ns_, waiting_->t_ns);
      advance();
    }
    item.stream = kEvents;
    item.record_ns = record_ns_;
    item.content = RecordedEvents{given_.data(), given_.size()};
    return true;
  }

  std::vector<ListedFrame> frames_;
  std::vector<RecordingDamage> damage_;
  std::vector<RecordedStream> streams_;
  std::optional<EventTextReader> events_;
  std::optional<Event> waiting_;  ///< the next one
  std::vector<Event> given_;
  std::optional<Picture> picture_;
  std::size_t frame_ = 0;
  std::int64_t record_ns_ = 0;
};

}  // namespace

std::unique_ptr<Recording> openPictureFolder(const std::string& path) {
  return std::make_unique<PictureFolderReader>(path);
}

}  // namespace fast_edi
