/// \file
/// Frames as PNG files and a list of their times, which structure from motion, radiance fields and
/// labelling tools read.
///
/// `frames.csv`, one line for each frame behind a line with the names:
///
///     index,file,stamp_ns,exposure_start_ns,exposure_end_ns
///     0,000000.png,1700000000035000000,1700000000020000000,1700000000050000000
///
/// Times are in nanoseconds; both exposure columns are empty where the exposure is not known.
#pragma once

#include <cstdint>
#include <fstream>
#include <optional>
#include <string>

#include <sensor_msgs/Image.h>

#include "fast_edi/base/types.hpp"

namespace fast_edi {

class FrameFolder {
 public:
  /// Makes the folder.
  /// \param overwrite write into a folder that holds a list already; its own files are replaced,
  ///        other files stay
  /// \throws RecordingError when it cannot be written
  FrameFolder(const std::string& path, bool overwrite);

  /// Bayer frames and 16 bits are written as they are, colours as PNG has them.
  /// \return false for an encoding or size that PNG does not have: counted in leftOut()
  /// \throws RecordingError when it cannot be written
  bool add(const sensor_msgs::Image& image, const std::optional<ExposureInterval>& exposure);
  /// \throws RecordingError when the list cannot be written
  void close();

  std::uint64_t frames() const { return frames_; }
  std::uint64_t leftOut() const { return left_out_; }

 private:
  const std::string path_;
  std::ofstream list_;
  std::uint64_t frames_ = 0;
  std::uint64_t left_out_ = 0;
};

}  // namespace fast_edi
