#include "fast_edi/hdf5/hdf5_reader.hpp"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <utility>

#include "fast_edi/recording/recording_error.hpp"
#include "hdf5/hdf5_events.hpp"
#include "hdf5/hdf5_frames.hpp"
#include "recording/merged_recording.hpp"

namespace fast_edi {
namespace {

class Hdf5Reader : public MergedRecording {
 public:
  explicit Hdf5Reader(const std::string& path) : file_(path), frames_(file_) {
    std::error_code ignored;  // it was opened
    file_size_ = std::filesystem::file_size(path, ignored);
    const std::optional<Hdf5EventPlace> place = findEvents(file_);
    if (!place && frames_.times().empty()) {
      throw RecordingError(
          path +
          " has neither events nor frames where they are looked for: expected the datasets "
          "events/x, y, t and p (DSEC), events/xs, ys, ts and ps (event_utils), x, y, t and p "
          "(e2calib), events with rows of t, x, y and p (v2e) or davis/left/events (MVSEC); frames "
          "in images/image000000000, ... with the attribute timestamp or in davis/left/image_raw");
    }
    for (const RecordingDamage& place_of_damage : frames_.damage()) {
      note(place_of_damage);
    }
    addFrames(frames_.times(), sizeOfFrames());
    if (place) {
      const std::vector<FrameTime>& times = frames_.times();
      events_.emplace(file_, *place, sizeOfFrames(),
                      times.empty() ? 0 : times.back().stamp_ns - times.front().stamp_ns);
      addEvents(events_->size());
    }
  }

  std::string format() const override { return "HDF5"; }
  std::uint64_t position() const override {
    return framesRead() + (events_ ? events_->position() : 0);
  }
  std::uint64_t length() const override { return frameCount() + (events_ ? events_->count() : 0); }
  std::uint64_t fileSize() const override { return file_size_; }

 private:
  /// Of the first frame that can be read.
  SensorSize sizeOfFrames() {
    for (std::size_t i = 0; i < frames_.times().size() && size_.pixelCount() == 0; ++i) {
      RecordedFrame frame;
      if (frames_.read(i, frame).empty()) {
        size_ = frame.size;
      }
    }
    return size_;
  }

  bool readFrame(std::size_t index, RecordedFrame& frame) override {
    const std::string fault = frames_.read(index, frame);
    if (!fault.empty()) {
      note({0, frames_.name(index) + ": " + fault});
    }
    return fault.empty();
  }

  void readEvents(EventBlock& block) override {
    std::string fault;
    while (block.events.empty() && events_->read(block.events, fault)) {
      block.lost = block.lost || events_->hasLost();
      if (!fault.empty()) {
        note({0, std::exchange(fault, {})});
      }
    }
  }

  Hdf5File file_;
  Hdf5Frames frames_;
  std::optional<Hdf5Events> events_;
  SensorSize size_;  ///< of the frames
  std::uint64_t file_size_ = 0;
};

}  // namespace

std::unique_ptr<Recording> openHdf5(const std::string& path) {
  return std::make_unique<Hdf5Reader>(path);
}

}  // namespace fast_edi
