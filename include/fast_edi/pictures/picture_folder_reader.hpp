/// \file
/// A folder of pictures and text as a recording: IJRR, EVDI, frames.csv and events.csv. What is
/// found out of the columns, units and coordinates: see frame_list.hpp and event_text.hpp.
///
/// Events are read as a stream, pictures one by one; only the list of frames is kept.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "fast_edi/recording/recording.hpp"

namespace fast_edi {

class PictureFolderReader : public Recording {
 public:
  /// Events of one item are no more, and span no more time.
  static constexpr std::size_t kMaxItemEvents = 100'000;
  static constexpr std::int64_t kMaxItem_ns = 10 * kNanosecondsPerMillisecond;

  /// \throws RecordingError when there are no frames, or their times or the events' columns are not
  ///         clear
  explicit PictureFolderReader(const std::string& path);
  ~PictureFolderReader() override;

  std::string format() const override;
  const std::vector<RecordedStream>& streams() const override;
  /// Frames come behind the events of their exposure; where only a stamp is known, behind those
  /// before it.
  bool next(RecordingItem& item) override;
  const std::vector<RecordingDamage>& damage() const override;
  std::uint64_t position() const override;
  std::uint64_t length() const override;
  std::uint64_t fileSize() const override;
  bool knowsExposures() const override;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fast_edi
