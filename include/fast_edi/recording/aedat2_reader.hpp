/// \file
/// AEDAT2, the format of jAER
/// (https://docs.inivation.com/software/software-advanced-usage/file-formats/aedat-2.0.html), of
/// DAVIS cameras.
///
/// Lines that begin with `#`, then big-endian records {u32 address, u32 time [us]}. A record is an
/// event, or one read of a pixel (reset or signal), or one number of the IMU. Columns of events are
/// counted from the right and rows from below, as jAER has them.
///
/// A frame is assembled of a reset and a signal read of each pixel: the level that light has taken
/// away, reset minus signal, in 10 bits, given as mono16 shifted up by 6. Its exposure lasts from
/// the last reset read to the first signal read (global shutter); where signal reads begin before
/// resets have ended (rolling shutter), from the first reset read to the first signal read, which
/// is that of the first column.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "fast_edi/recording/byte_source.hpp"
#include "fast_edi/recording/recording.hpp"

namespace fast_edi {

class Aedat2Reader : public Recording {
 public:
  /// More events come in several items.
  static constexpr std::size_t kMaxItemEvents = 100'000;
  /// An item spans no more.
  static constexpr std::int64_t kMaxItem_us = 10'000;

  /// \throws RecordingError when the file cannot be opened, or was recorded by a camera that is no
  ///         DAVIS240 or DAVIS346
  explicit Aedat2Reader(const std::string& path);
  ~Aedat2Reader() override;

  std::string format() const override { return "AEDAT2"; }
  const std::vector<RecordedStream>& streams() const override;
  bool next(RecordingItem& item) override;
  const std::vector<RecordingDamage>& damage() const override;
  std::uint64_t position() const override;
  std::uint64_t length() const override;
  std::uint64_t fileSize() const override;
  bool knowsExposures() const override { return true; }

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fast_edi
