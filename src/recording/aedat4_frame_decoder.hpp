/// \file
/// Frames of AEDAT4.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "fast_edi/base/types.hpp"
#include "fast_edi/recording/recording.hpp"
#include "recording/flatbuffer.hpp"

namespace fast_edi {

/// Decodes the table of a frame.
class Aedat4FrameDecoder {
 public:
  /// Width and height that a frame states.
  static SensorSize sizeOf(const FlatTable& table);

  /// \param sensor that the frame comes from; zero size if it is not known. A frame of a part of it
  ///        is put where it belongs, the rest stays black.
  /// \param frame set unless something is wrong; its pixels lie in the table or in this, until the
  ///        next call
  /// \return what is wrong; empty if nothing is
  std::string decode(const FlatTable& table, SensorSize sensor, RecordedFrame& frame);

 private:
  /// Puts a frame of a part of the sensor where it belongs.
  void place(RecordedFrame& frame, SensorSize sensor, int left, int top, std::size_t pixel_bytes);

  std::vector<std::uint8_t> canvas_;
};

}  // namespace fast_edi
