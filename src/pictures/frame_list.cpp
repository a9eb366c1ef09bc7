#include "pictures/frame_list.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <initializer_list>
#include <memory>
#include <utility>

#include "fast_edi/recording/recording_error.hpp"
#include "pictures/text_table.hpp"
#include "recording/damage_notes.hpp"

namespace fast_edi {
namespace {

namespace fs = std::filesystem;

/// Frames come no faster; 1000 times as slow is the next unit.
constexpr double kLeastPeriod_ns = 2e6;

/// Of a list, which is kept.
constexpr std::uint64_t kMaxListBytes = std::uint64_t{64} << 20;

const char* const kExposureStarts = "Exposure_start.txt";
const char* const kExposureEnds = "Exposure_end.txt";
const char* const kBlurryPictures = "Blur";

/// Times as a list holds them, before their unit is known.
struct Row {
  std::string name;  ///< of the picture
  std::uint64_t offset = 0;
  std::optional<Decimal> stamp, start, end;
};

struct Columns {
  std::size_t file = kAbsent;
  std::size_t stamp = kAbsent;
  std::size_t start = kAbsent;
  std::size_t end = kAbsent;
  std::optional<int> unit;
};

std::string firstOf(const FileSet& files, std::initializer_list<const char*> names) {
  for (const char* name : names) {
    if (files.has(name)) {
      return name;
    }
  }
  return {};
}

std::string listOf(const FileSet& files) {
  return firstOf(files, {"frames.csv", "images.csv", "images.txt", "frames.txt"});
}

/// \throws RecordingError also for a list that is too long to be kept
LineReader openList(const FileSet& files, const std::string& name) {
  std::unique_ptr<ByteStream> list = files.open(name);
  if (list->size() > kMaxListBytes) {
    throw RecordingError(files.pathOf(name) + ": " + std::to_string(list->size()) +
                         " bytes, expected a list of at most " + std::to_string(kMaxListBytes));
  }
  return LineReader(std::move(list));
}

bool isOneOf(const std::string& name, std::initializer_list<const char*> names) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

Columns namedColumns(const std::vector<std::string_view>& fields) {
  Columns columns;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const ColumnName column = parseColumnName(fields[i]);
    std::size_t* place = nullptr;
    if (isOneOf(column.name, {"file", "filename", "file_name", "image", "path", "name", "frame"})) {
      place = &columns.file;
    } else if (isOneOf(column.name, {"stamp", "t", "time", "timestamp", "ts"})) {
      place = &columns.stamp;
    } else if (isOneOf(column.name, {"exposure_start", "exp_start", "start", "t_start"})) {
      place = &columns.start;
    } else if (isOneOf(column.name, {"exposure_end", "exp_end", "end", "t_end"})) {
      place = &columns.end;
    }
    if (place != nullptr && *place == kAbsent) {
      *place = i;
      columns.unit = column.unit ? column.unit : columns.unit;
    }
  }
  return columns;
}

/// Of a line without names: numbers are times, what is none is the file.
Columns unnamedColumns(const std::vector<std::string_view>& fields) {
  Columns columns;
  std::vector<std::size_t> times;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (parseDecimal(fields[i])) {
      times.push_back(i);
    } else {
      columns.file = i;
    }
  }
  if (times.size() == 1) {
    columns.stamp = times[0];
  } else if (times.size() == 2) {
    columns.start = times[0];
    columns.end = times[1];
  }
  return columns;
}

bool isSound(const Columns& columns) {
  const bool exposed = columns.start != kAbsent && columns.end != kAbsent;
  return columns.file != kAbsent && (columns.stamp != kAbsent || exposed);
}

/// Names with numbers in the order of their numbers: 2.png before 10.png.
bool comesBefore(const std::string& a, const std::string& b) {
  const auto number = [](const std::string& name) {
    std::string digits;
    for (const char c : fs::path(name).stem().string()) {
      if (std::isdigit(static_cast<unsigned char>(c)) != 0 && !(digits.empty() && c == '0')) {
        digits += c;
      }
    }
    return std::pair(digits.size(), digits);
  };
  return std::pair(number(a), a) < std::pair(number(b), b);
}

class ListReader {
 public:
  explicit ListReader(const FileSet& files) : files_(files) {}

  FrameList read() {
    const std::string list = listOf(files_);
    if (list.empty()) {
      readExposures();
    } else {
      readList(list);
    }
    FrameList result;
    if (rows_.empty()) {
      throw RecordingError(files_.pathOf("") +
                           ": no frame is listed, expected pictures and their times");
    }
    const int unit = unit_ ? *unit_ : guessUnit();
    for (const Row& row : rows_) {
      addFrame(row, unit, result);
    }
    std::stable_sort(result.frames.begin(), result.frames.end(), [](const auto& a, const auto& b) {
      return a.time.stamp_ns < b.time.stamp_ns;
    });
    result.damage = std::move(damage_);
    return result;
  }

 private:
  void note(std::uint64_t offset, const std::string& what) { noteDamage(damage_, {offset, what}); }

  void readList(const std::string& name) {
    LineReader lines = openList(files_, name);
    std::optional<Columns> columns;
    std::vector<std::string_view> fields;
    while (const auto line = lines.next()) {
      std::string_view text = *line;
      const bool comment = !text.empty() && text[0] == '#';
      if (comment) {
        text.remove_prefix(1);
      }
      splitFields(text, fields);
      if (fields.empty()) {
        continue;
      }
      if (!columns) {
        const Columns named = namedColumns(fields);
        if (isSound(named)) {
          columns = named;
          unit_ = named.unit;
          continue;
        }
        if (comment) {
          continue;
        }
        columns = unnamedColumns(fields);
        if (!isSound(*columns)) {
          throw RecordingError(files_.pathOf(name) + ", line " + std::to_string(lines.number()) +
                               ": found \"" + std::string(text.substr(0, 80)) +
                               "\", expected a time and a file, or the names of the columns");
        }
      }
      if (!comment) {
        addRow(*columns, fields, *line, name, lines);
      }
    }
    noteEnd(lines, name);
  }

  void noteEnd(const LineReader& lines, const std::string& name) {
    if (!lines.fault().empty()) {
      note(lines.position(), "of " + name + ": " + lines.fault());
    }
  }

  void addRow(const Columns& columns, const std::vector<std::string_view>& fields,
              std::string_view line, const std::string& name, const LineReader& lines) {
    const auto field = [&fields](std::size_t column) {
      return column < fields.size() ? fields[column] : std::string_view();
    };
    Row row;
    row.offset = lines.offset();
    row.name = std::string(field(columns.file));
    row.stamp = parseDecimal(field(columns.stamp));
    row.start = parseDecimal(field(columns.start));
    row.end = parseDecimal(field(columns.end));
    if (field(columns.file).empty() || (!row.stamp && !(row.start && row.end))) {
      note(row.offset, "of " + name + ", line " + std::to_string(lines.number()) + ": found \"" +
                           std::string(line.substr(0, 80)) + "\", expected a file and its time");
      return;
    }
    rows_.push_back(std::move(row));
  }

  void readExposures() {
    std::vector<std::string> pictures = files_.list(kBlurryPictures);
    std::sort(pictures.begin(), pictures.end(), comesBefore);
    const std::vector<Row> starts = readTimes(kExposureStarts);
    const std::vector<Row> ends = readTimes(kExposureEnds);
    const std::size_t count = std::min({pictures.size(), starts.size(), ends.size()});
    if (starts.size() != count || ends.size() != count || pictures.size() != count) {
      note(0, std::to_string(pictures.size()) + " pictures in " + kBlurryPictures + ", " +
                  std::to_string(starts.size()) + " times in " + kExposureStarts + " and " +
                  std::to_string(ends.size()) + " in " + kExposureEnds +
                  ", expected as many of each");
    }
    for (std::size_t i = 0; i < count; ++i) {
      rows_.push_back(
          {pictures[i], starts[i].offset, std::nullopt, starts[i].start, ends[i].start});
    }
  }

  std::vector<Row> readTimes(const char* name) {
    LineReader lines = openList(files_, name);
    std::vector<Row> rows;
    std::vector<std::string_view> fields;
    while (const auto line = lines.next()) {
      splitFields(*line, fields);
      if (fields.empty()) {
        continue;
      }
      Row row;
      row.offset = lines.offset();
      row.start = parseDecimal(fields.back());
      if (!row.start) {
        throw RecordingError(files_.pathOf(name) + ", line " + std::to_string(lines.number()) +
                             ": found \"" + std::string(line->substr(0, 80)) +
                             "\", expected a time");
      }
      rows.push_back(std::move(row));
    }
    noteEnd(lines, name);
    return rows;
  }

  /// That in which frames come 2 ms to 2 s apart; of a single one, its exposure lasts that long.
  int guessUnit() const {
    std::vector<double> periods;
    for (std::size_t i = 1; i < rows_.size(); ++i) {
      periods.push_back(timeOf(rows_[i]) - timeOf(rows_[i - 1]));
    }
    if (periods.empty() && rows_[0].start && rows_[0].end) {
      periods.push_back(rows_[0].end->value() - rows_[0].start->value());
    }
    if (!periods.empty()) {
      const auto middle = periods.begin() + static_cast<std::ptrdiff_t>(periods.size() / 2);
      std::nth_element(periods.begin(), middle, periods.end());
      double scale = 1.0;
      for (const int unit : {kNanoseconds, kMicroseconds, kMilliseconds, kSeconds}) {
        const double period_ns = *middle * scale;
        if (period_ns >= kLeastPeriod_ns && period_ns < kLeastPeriod_ns * 1000.0) {
          return unit;
        }
        scale *= 1000.0;
      }
    }
    throw RecordingError(files_.pathOf("") +
                         ": the unit of the frames' times is not clear; name it in a first line of "
                         "the list, e.g. \"stamp_us file\" (_s, _ms, _us, _ns)");
  }

  static double timeOf(const Row& row) {
    return row.start ? row.start->value() : row.stamp->value();
  }

  void addFrame(const Row& row, int unit, FrameList& result) {
    const auto scaled = [unit](const std::optional<Decimal>& decimal) {
      return decimal ? decimal->scaled(unit) : std::nullopt;
    };
    const std::optional<FrameTime> time =
        frameTimeOf(scaled(row.stamp), scaled(row.start), scaled(row.end));
    if (!time) {
      note(row.offset, "of the frame " + fs::path(row.name).filename().string() +
                           ": no usable time, expected 0 to 2^32 s and an exposure that ends after "
                           "its start");
      return;
    }
    result.frames.push_back({row.name, *time});
  }

  const FileSet& files_;
  std::vector<Row> rows_;
  std::optional<int> unit_;
  std::vector<RecordingDamage> damage_;
};

}  // namespace

bool hasFrameList(const FileSet& files) {
  return !listOf(files).empty() || (files.has(kExposureStarts) && files.has(kExposureEnds));
}

FrameList readFrameList(const FileSet& files) {
  return ListReader(files).read();
}

}  // namespace fast_edi
