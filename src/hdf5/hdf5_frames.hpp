/// \file
/// Frames as arrays of pixels; see fast_edi/hdf5/hdf5_reader.hpp for where they lie.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "fast_edi/recording/recording.hpp"
#include "hdf5/hdf5_dataset.hpp"
#include "recording/merged_recording.hpp"

namespace fast_edi {

class Hdf5Frames {
 public:
  /// Larger ones are refused: a small file may claim gigabytes.
  static constexpr std::size_t kMaxPixels = std::size_t{1} << 24;

  /// Finds the frames of \p file, which must outlive this; there may be none.
  /// \throws RecordingError when there are frames, but none has a usable time
  explicit Hdf5Frames(const Hdf5File& file);

  /// In order.
  const std::vector<FrameTime>& times() const { return times_; }
  /// Frames that have no usable time, and are left out.
  const std::vector<RecordingDamage>& damage() const { return damage_; }
  /// Name of a frame, for messages.
  std::string name(std::size_t index) const;
  /// Reads a frame; sets size, encoding, pixels and bytes.
  /// \return what is wrong; empty if nothing is
  std::string read(std::size_t index, RecordedFrame& frame);

 private:
  void findImages();
  void findStack();
  std::string readPixels(Hdf5Dataset& dataset, std::size_t first_dimension, hsize_t row,
                         const std::string& encoding, RecordedFrame& frame);

  const Hdf5File& file_;
  std::vector<std::string> names_;       ///< of datasets with a frame each
  std::unique_ptr<Hdf5Dataset> stack_;   ///< of one dataset with all of them
  std::vector<std::size_t> stack_rows_;  ///< of each frame
  std::vector<FrameTime> times_;
  std::vector<RecordingDamage> damage_;
  std::vector<std::uint8_t> pixels_;
};

}  // namespace fast_edi
