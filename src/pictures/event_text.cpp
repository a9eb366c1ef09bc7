#include "pictures/event_text.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "fast_edi/exposure/stamp_limits.hpp"
#include "fast_edi/recording/recording_error.hpp"

namespace fast_edi {
namespace {

constexpr std::size_t kTime = 0;
constexpr std::size_t kX = 1;
constexpr std::size_t kY = 2;
constexpr std::size_t kPolarity = 3;
constexpr std::size_t kColumns = 4;
/// Time may fall in one of so many lines.
constexpr std::size_t kLinesForOneFall = 100;
/// What the layout is found out by.
constexpr std::size_t kSampleLines = 20'000;
constexpr std::size_t kMaxNotes = 1000;
constexpr std::size_t kShownBytes = 80;
/// Bytes at the end of the file that hold its last line.
constexpr std::size_t kTailBytes = 4096;

using EventRow = std::array<double, kColumns>;

/// What the first lines say of a column.
struct ColumnRange {
  double least = std::numeric_limits<double>::infinity();
  double most = -std::numeric_limits<double>::infinity();
  std::size_t falls = 0;

  double span() const { return most - least; }
};

std::array<ColumnRange, kColumns> rangesOf(const std::vector<EventRow>& rows) {
  std::array<ColumnRange, kColumns> ranges;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (std::size_t c = 0; c < kColumns; ++c) {
      ColumnRange& range = ranges[c];
      range.least = std::min(range.least, rows[i][c]);
      range.most = std::max(range.most, rows[i][c]);
      range.falls += i > 0 && rows[i][c] < rows[i - 1][c] ? 1 : 0;
    }
  }
  return ranges;
}

bool isPolarity(const std::vector<EventRow>& rows, std::size_t column) {
  return std::all_of(rows.begin(), rows.end(), [column](const EventRow& row) {
    return row[column] == 0.0 || row[column] == 1.0 || row[column] == -1.0;
  });
}

/// Columns by names; those that are not named are kAbsent.
EventTextLayout namedLayout(const std::vector<std::string_view>& fields, std::optional<int>& unit) {
  EventTextLayout layout;
  layout.columns.fill(kAbsent);
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const ColumnName column = parseColumnName(fields[i]);
    const std::string& name = column.name;
    if (name == "t" || name == "ts" || name == "time" || name == "timestamp" || name == "stamp") {
      layout.columns[kTime] = i;
      unit = column.unit;
    } else if (name == "x" || name == "y") {
      layout.columns[name == "x" ? kX : kY] = i;
    } else if (name == "p" || name == "pol" || name == "polarity" || name == "on") {
      layout.columns[kPolarity] = i;
    }
  }
  return layout;
}

bool isWhole(const EventTextLayout& layout) {
  return std::count(layout.columns.begin(), layout.columns.end(), kAbsent) == 0;
}

/// Columns by what the first lines hold; nothing when that is not clear.
std::optional<EventTextLayout> layoutOf(const std::vector<EventRow>& rows, SensorSize size) {
  const std::array<ColumnRange, kColumns> ranges = rangesOf(rows);
  EventTextLayout layout;
  layout.columns.fill(kAbsent);
  for (std::size_t c = 0; c < kColumns; ++c) {
    if (isPolarity(rows, c)) {
      layout.columns[kPolarity] = c;  // the last of those that might be
    }
  }
  const auto is_time = [&](std::size_t c) {
    return c != layout.columns[kPolarity] && ranges[c].falls <= rows.size() / kLinesForOneFall;
  };
  for (std::size_t c = 0; c < kColumns; ++c) {
    std::size_t& time = layout.columns[kTime];
    if (is_time(c) && (time == kAbsent || std::pair(ranges[time].falls, ranges[c].most) >
                                              std::pair(ranges[c].falls, ranges[time].most))) {
      time = c;
    }
  }
  if (layout.columns[kPolarity] == kAbsent || layout.columns[kTime] == kAbsent) {
    return std::nullopt;
  }
  for (std::size_t c = 0; c < kColumns; ++c) {
    if (c != layout.columns[kPolarity] && c != layout.columns[kTime]) {
      layout.columns[layout.columns[kX] == kAbsent ? kX : kY] = c;
    }
  }
  const double first = ranges[layout.columns[kX]].most;
  const double second = ranges[layout.columns[kY]].most;
  if ((first > size.width || second > size.height) && second <= size.width &&
      first <= size.height) {
    std::swap(layout.columns[kX], layout.columns[kY]);
  }
  return layout;
}

}  // namespace

std::string eventTextOf(const FileSet& files) {
  for (const char* name : {"events.txt", "Events.txt", "events.csv", "Events.csv", "event.txt"}) {
    if (files.has(name)) {
      return name;
    }
  }
  return {};
}

EventTextReader::EventTextReader(const FileSet& files, const std::string& name, SensorSize size,
                                 const std::vector<std::int64_t>& frames)
    : files_(files), name_(name), size_(size), lines_(files.open(name)) {
  findLayout(frames);
}

void EventTextReader::findLayout(const std::vector<std::int64_t>& frames) {
  LineReader lines(files_.open(name_));
  std::optional<EventTextLayout> named;
  std::optional<int> unit;
  std::vector<EventRow> rows;
  std::vector<std::string_view> fields;
  while (rows.size() < kSampleLines) {
    const auto line = lines.next();
    if (!line) {
      break;
    }
    std::string_view text = *line;
    const bool comment = !text.empty() && text[0] == '#';
    if (comment) {
      text.remove_prefix(1);
    }
    splitFields(text, fields);
    if (rows.empty() && !named) {
      const EventTextLayout layout = namedLayout(fields, unit);
      if (isWhole(layout)) {
        named = layout;
        continue;
      }
    }
    EventRow row = {};
    bool sound = !comment && fields.size() >= kColumns;
    for (std::size_t c = 0; sound && c < kColumns; ++c) {
      const std::optional<Decimal> number = parseDecimal(fields[named ? named->columns[c]
                                                                : c < fields.size() ? c
                                                                                    : 0]);
      sound = number.has_value();
      row[c] = sound ? number->value() : 0.0;
    }
    if (sound) {
      rows.push_back(row);
    }
    if (rows.empty() && lines.number() > kMaxNotes) {
      break;
    }
  }
  if (rows.empty()) {
    throw RecordingError(files_.pathOf(name_) + ": no event within the first " +
                         std::to_string(lines.number()) +
                         " lines, expected lines of time, x, y and polarity");
  }
  std::array<std::size_t, kColumns> of_rows = {kTime, kX, kY, kPolarity};
  if (named) {
    layout_ = *named;
  } else {
    const std::optional<EventTextLayout> found = layoutOf(rows, size_);
    if (!found) {
      throw RecordingError(files_.pathOf(name_) +
                           ": the order of the columns is not clear; name it in the first line, "
                           "e.g. \"# t_us x y p\"");
    }
    layout_ = *found;
    of_rows = layout_.columns;
  }
  const std::array<ColumnRange, kColumns> ranges = rangesOf(rows);
  const ColumnRange& x = ranges[of_rows[kX]];
  const ColumnRange& y = ranges[of_rows[kY]];
  layout_.origin =
      x.least >= 1.0 && y.least >= 1.0 && (x.most == size_.width || y.most == size_.height) ? 1 : 0;
  if (unit) {
    layout_.unit = *unit;
    return;
  }
  const double first = rows.front()[of_rows[kTime]];
  const double last = lastTime().value_or(rows.back()[of_rows[kTime]]);
  layout_.unit = guessUnit(first, last, frames);
}

std::optional<double> EventTextReader::lastTime() const {
  const std::string end_of_text = files_.tail(name_, kTailBytes);
  std::string_view tail(end_of_text);
  std::vector<std::string_view> fields;
  while (!tail.empty()) {
    const std::size_t end = tail.find_last_of('\n');
    splitFields(end == std::string_view::npos ? tail : tail.substr(end + 1), fields);
    if (fields.size() >= kColumns) {
      if (const std::optional<Decimal> time = parseDecimal(fields[layout_.columns[kTime]])) {
        return time->value();
      }
    }
    tail = end == std::string_view::npos ? std::string_view() : tail.substr(0, end);
  }
  return std::nullopt;
}

int EventTextReader::guessUnit(double first, double last,
                               const std::vector<std::int64_t>& frames) const {
  const double frames_ns =
      frames.size() > 1 ? static_cast<double>(frames.back() - frames.front()) : 0.0;
  if (!(last > first) || frames_ns <= 0.0) {
    throw RecordingError(files_.pathOf(name_) +
                         ": the unit of time is not clear; name it in the first line, e.g. "
                         "\"# t_us x y p\" (_s, _ms, _us, _ns)");
  }
  int best = kSeconds;
  double least = std::numeric_limits<double>::infinity();
  for (const int unit : {kSeconds, kMilliseconds, kMicroseconds, kNanoseconds}) {
    const double distance = std::abs(std::log((last - first) * std::pow(10.0, unit) / frames_ns));
    if (distance < least) {
      least = distance;
      best = unit;
    }
  }
  return best;
}

void EventTextReader::note(std::string_view line, const std::string& expected) {
  ++bad_lines_;
  if (bad_lines_ <= kMaxNotes) {
    damage_.push_back({lines_.offset(),
                       "of " + name_ + ", line " + std::to_string(lines_.number()) + ": found \"" +
                           std::string(line.substr(0, kShownBytes)) + "\", expected " + expected});
  }
}

bool EventTextReader::next(Event& event) {
  while (const auto line = lines_.next()) {
    splitFields(*line, fields_);
    if (fields_.empty() || fields_[0][0] == '#') {
      continue;
    }
    std::array<std::optional<Decimal>, kColumns> numbers;
    bool sound = fields_.size() >= kColumns;
    for (std::size_t c = 0; sound && c < kColumns; ++c) {
      const std::size_t column = layout_.columns[c];
      numbers[c] = column < fields_.size() ? parseDecimal(fields_[column]) : std::nullopt;
      sound = numbers[c].has_value();
    }
    if (!sound) {
      if (lines_.number() > 1) {  // the first line may have names or the sensor's size
        note(*line, "time, x, y and polarity");
      }
      continue;
    }
    const std::optional<std::int64_t> t_ns = numbers[kTime]->scaled(layout_.unit);
    const std::optional<std::int64_t> x = numbers[kX]->scaled(0);
    const std::optional<std::int64_t> y = numbers[kY]->scaled(0);
    if (!t_ns || !isStamp(*t_ns)) {
      note(*line, "a time from 0 to 2^32 s");
      continue;
    }
    const std::int64_t column = x.value_or(-1) - layout_.origin;
    const std::int64_t row = y.value_or(-1) - layout_.origin;
    if (column < 0 || column >= size_.width || row < 0 || row >= size_.height) {
      note(*line, "a pixel of the " + std::to_string(size_.width) + "x" +
                      std::to_string(size_.height) + " that the frames have");
      continue;
    }
    event.x = static_cast<std::uint16_t>(column);
    event.y = static_cast<std::uint16_t>(row);
    event.t_ns = *t_ns;
    event.on = numbers[kPolarity]->mantissa > 0;
    return true;
  }
  if (!ended_ && !lines_.fault().empty()) {
    damage_.push_back({lines_.position(), "of " + name_ + ": " + lines_.fault()});
  }
  ended_ = true;
  return false;
}

}  // namespace fast_edi
