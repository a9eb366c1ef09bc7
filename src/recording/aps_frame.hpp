/// \file
/// Frames of a DAVIS from single reads of its pixels.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "fast_edi/base/types.hpp"

namespace fast_edi {

/// Collects reset and signal reads until each pixel has both; see aedat2_reader.hpp.
class ApsFrame {
 public:
  /// Samples have that many bits.
  static constexpr int kSampleBits = 10;

  explicit ApsFrame(SensorSize size);

  /// \pre x, y on the sensor
  /// \return whether reads of a frame that is not complete were dropped for this one
  bool addReset(int x, int y, std::uint16_t sample, std::int64_t t_ns);
  /// A signal read before its reset read is not used.
  void addSignal(int x, int y, std::uint16_t sample, std::int64_t t_ns);

  bool complete() const { return signals_ == size_.pixelCount(); }
  /// One more signal read may complete it.
  bool missesOneSignal() const { return signals_ + 1 == size_.pixelCount(); }
  /// Nothing was read so far.
  bool empty() const { return resets_ == 0; }
  /// \pre complete()
  ExposureInterval exposure() const;
  /// The frame as mono16, row by row. \pre complete()
  const std::vector<std::uint16_t>& pixels();
  void clear();

 private:
  enum State : std::uint8_t { kUnread, kReset, kSignal };

  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(size_.width) +
           static_cast<std::size_t>(x);
  }

  SensorSize size_;
  std::vector<std::uint8_t> states_;
  std::vector<std::int32_t> levels_;  ///< reset, then reset minus signal
  std::vector<std::uint16_t> pixels_;
  std::size_t resets_ = 0;
  std::size_t signals_ = 0;
  std::int64_t first_reset_ns_ = 0;
  std::int64_t last_reset_ns_ = 0;
  std::int64_t first_signal_ns_ = 0;
};

}  // namespace fast_edi
