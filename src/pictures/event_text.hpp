/// \file
/// Events as lines of text, in any order of columns.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "fast_edi/base/types.hpp"
#include "fast_edi/recording/recording.hpp"
#include "pictures/text_table.hpp"
#include "recording/file_set.hpp"

namespace fast_edi {

/// How the lines are to be read.
struct EventTextLayout {
  std::array<std::size_t, 4> columns = {};  ///< of time, x, y and polarity
  int unit = kSeconds;                      ///< of time, see text_table.hpp
  int origin = 0;                           ///< of coordinates: 0 or 1
};

/// The file of events among \p files, or empty.
std::string eventTextOf(const FileSet& files);

/// Reads the events of a text file one after the other.
///
/// Columns: by their names in the first line, also of a comment ("# t_us x y p"), else by the first
/// lines' content: polarities are -1, 0 or 1, time hardly ever falls, and of the rest x comes
/// before y unless just the other order fits the frames. Coordinates are from 1 where they reach
/// the width or height of the frames and never 0. The unit of time is the one that the name tells,
/// else the one by which events last as long as the frames.
class EventTextReader {
 public:
  /// \param files must outlive this
  /// \param name of the file of events
  /// \param frames when frames were taken [ns], in order
  /// \throws RecordingError when the file cannot be opened, or its layout is not clear
  EventTextReader(const FileSet& files, const std::string& name, SensorSize size,
                  const std::vector<std::int64_t>& frames);

  /// The next event on the sensor; false at the end.
  bool next(Event& event);
  const EventTextLayout& layout() const { return layout_; }
  /// Lines that cannot be read, in all; the first of them are in takeDamage().
  std::uint64_t badLines() const { return bad_lines_; }
  std::vector<RecordingDamage> takeDamage() { return std::exchange(damage_, {}); }
  std::uint64_t position() const { return lines_.position(); }
  std::uint64_t size() const { return lines_.size(); }

 private:
  void findLayout(const std::vector<std::int64_t>& frames);
  int guessUnit(double first, double last, const std::vector<std::int64_t>& frames) const;
  std::optional<double> lastTime() const;
  void note(std::string_view line, const std::string& expected);

  const FileSet& files_;
  const std::string name_;
  const SensorSize size_;
  LineReader lines_;
  EventTextLayout layout_;
  std::vector<std::string_view> fields_;
  std::vector<RecordingDamage> damage_;
  std::uint64_t bad_lines_ = 0;
  bool ended_ = false;
};

}  // namespace fast_edi
