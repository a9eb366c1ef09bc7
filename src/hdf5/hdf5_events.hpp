/// \file
/// Events as columns of numbers; see fast_edi/hdf5/hdf5_reader.hpp for where they lie.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fast_edi/base/types.hpp"
#include "hdf5/hdf5_dataset.hpp"

namespace fast_edi {

/// Where the events of a file lie.
struct Hdf5EventPlace {
  std::string group;                        ///< has their attributes; "/" for the file
  std::array<std::string, 4> columns;       ///< datasets: time, x, y, polarity
  std::array<std::size_t, 4> indices = {};  ///< of the same in rows, where columns are all one
  bool in_rows = false;
};

/// Nothing where there are none.
std::optional<Hdf5EventPlace> findEvents(const Hdf5File& file);

class Hdf5Events {
 public:
  static constexpr std::size_t kBlockEvents = 65'536;

  /// \param file must outlive this
  /// \param frames their size; zero if there are none
  /// \param frames_last_ns from the first frame to the last, 0 if that is not known
  /// \throws RecordingError
  Hdf5Events(const Hdf5File& file, const Hdf5EventPlace& place, SensorSize frames,
             std::int64_t frames_last_ns);

  /// That of the frames, else as recorded, else the smallest known sensor that holds the events of
  /// some blocks.
  SensorSize size() const { return size_; }
  std::uint64_t count() const { return count_; }
  std::uint64_t position() const { return next_; }

  /// Appends the next events that are on the sensor.
  /// \param fault what of them was left out, and why; empty if nothing was
  /// \return false at the end
  bool read(std::vector<Event>& events, std::string& fault);
  /// Whether the last call has lost events that nobody can know of.
  bool hasLost() const { return has_lost_; }

 private:
  /// Columns of a block; times are whole or not, as the file has them.
  struct Block {
    std::vector<std::int64_t> whole_times;
    std::vector<double> times;
    std::array<std::vector<std::int32_t>, 3> places;  ///< x, y, polarity
    std::vector<double> rows;
  };

  std::string readBlock(std::uint64_t first, std::size_t count);
  std::string readRows(std::uint64_t first, std::size_t count);
  void findUnit(std::int64_t frames_last_ns);
  void findOffset();
  void findSize(SensorSize frames);
  SensorSize statedSize() const;
  SensorSize sizeOfSamples();
  std::optional<std::int64_t> timeAt(std::size_t i) const;

  const Hdf5File& file_;
  const Hdf5EventPlace place_;
  std::vector<Hdf5Dataset> datasets_;  ///< those of the columns, or the one with rows
  bool has_whole_times_ = false;
  std::int64_t unit_ns_ = 1;
  std::int64_t offset_ns_ = 0;  ///< added to all times
  SensorSize size_;
  std::uint64_t count_ = 0;
  std::uint64_t next_ = 0;
  Block block_;
  bool has_lost_ = false;
};

}  // namespace fast_edi
