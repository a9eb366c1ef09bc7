/// \file
/// Events in columns, as DSEC has them.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "fast_edi/base/types.hpp"
#include "hdf5/hdf5_output.hpp"

namespace fast_edi {

/// Writes `events/x`, `y`, `t` [us since `t_offset`], `p`, and `ms_to_idx`: for each millisecond
/// the first event at or after it.
class Hdf5EventWriter {
 public:
  /// \param output must outlive this
  explicit Hdf5EventWriter(const Hdf5Output& output);

  /// \throws RecordingError
  void add(const Event& event);
  /// Writes what is left.
  /// \throws RecordingError
  void finish();

 private:
  void flush();

  /// Written together.
  struct Columns {
    std::vector<std::uint16_t> x, y;
    std::vector<std::int64_t> t_us;
    std::vector<std::uint8_t> polarity;
  };

  const Hdf5Output& output_;
  Hdf5Handle x_;
  Hdf5Handle y_;
  Hdf5Handle t_;
  Hdf5Handle polarity_;
  Columns waiting_;
  std::optional<std::int64_t> offset_us_;  ///< what times are counted from
  std::vector<std::uint64_t> first_of_ms_;
  std::uint64_t written_ = 0;
};

}  // namespace fast_edi
