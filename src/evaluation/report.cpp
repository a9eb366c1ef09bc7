#include "evaluation/report.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <ostream>
#include <sstream>
#include <stdexcept>

#include <opencv2/imgcodecs.hpp>

#include "evaluation/plot.hpp"

namespace fast_edi {
namespace {

namespace fs = std::filesystem;

constexpr char kNoValue[] = "-";

std::string fixed(double value, int decimals) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(decimals) << value;
  return text.str();
}

std::string cell(const std::optional<double>& value, int decimals) {
  return value ? fixed(*value, decimals) : kNoValue;
}

std::string gainOver(const std::optional<double>& value, const std::optional<double>& base) {
  if (!value || !base || *base <= 0.0) {
    return "";
  }
  const double percent = 100.0 * (*value / *base - 1.0);
  return std::string(" (") + (percent >= 0.0 ? "+" : "") + fixed(percent, 0) + " %)";
}

std::string nameWithUnit(const MeasureInfo& info) {
  std::string name = info.name;
  if (info.unit[0] != '\0') {
    name += std::string(" [") + info.unit + "]";
  }
  return name;
}

/// All columns in the order of reports: the truth comes last.
std::vector<std::size_t> columnsOf(const EvaluationGroup& group) {
  std::vector<std::size_t> columns;
  for (const Method method : kAllMethods) {
    if (method != Method::kTruth) {
      columns.push_back(indexOf(method));
    }
  }
  const std::size_t others = group.members.empty() ? 0 : group.members.front()->others.size();
  for (std::size_t i = 0; i < others; ++i) {
    columns.push_back(kMethodCount + i);
  }
  columns.push_back(indexOf(Method::kTruth));
  return columns;
}

std::string columnName(const Evaluation& evaluation, std::size_t column) {
  return column < kMethodCount ? toString(static_cast<Method>(column))
                               : evaluation.others[column - kMethodCount];
}

std::string columnName(const EvaluationGroup& group, std::size_t column) {
  return columnName(*group.members.front(), column);
}

bool anyColumnHas(const EvaluationGroup& group, Measure measure) {
  const std::vector<std::size_t> columns = columnsOf(group);
  return std::any_of(columns.begin(), columns.end(), [&](std::size_t column) {
    return meanOver(group.members, column, measure).has_value();
  });
}

std::vector<Measure> measuresIn(const EvaluationGroup& group) {
  std::vector<Measure> measures;
  for (std::size_t i = 0; i < kMeasureCount; ++i) {
    if (anyColumnHas(group, static_cast<Measure>(i))) {
      measures.push_back(static_cast<Measure>(i));
    }
  }
  return measures;
}

/// Columns that have a figure for any of the measures: truth is often not known, and is not
/// compared with itself.
std::vector<std::size_t> columnsWith(const EvaluationGroup& group,
                                     const std::vector<Measure>& measures) {
  std::vector<std::size_t> columns;
  for (const std::size_t column : columnsOf(group)) {
    if (std::any_of(measures.begin(), measures.end(), [&](Measure measure) {
          return meanOver(group.members, column, measure).has_value();
        })) {
      columns.push_back(column);
    }
  }
  return columns;
}

void printHeader(std::ostream& out, const std::string& first, const EvaluationGroup& group,
                 const std::vector<std::size_t>& columns) {
  out << "| " << first << " |";
  for (const std::size_t column : columns) {
    out << " " << columnName(group, column) << " |";
  }
  out << "\n|---|";
  for (std::size_t i = 0; i < columns.size(); ++i) {
    out << "---:|";
  }
  out << "\n";
}

void writePicture(const fs::path& path, const cv::Mat& picture) {
  bool written = false;
  try {
    written = cv::imwrite(path.string(), picture);
  } catch (const cv::Exception& error) {
    throw std::runtime_error("cannot write " + path.string() + ": " + error.what());
  }
  if (!written) {
    throw std::runtime_error("cannot write " + path.string());
  }
}

constexpr const char* kPage = "report.md";
constexpr const char* kFigures = "figures.csv";

/// The pictures beside a report that it shows. None when there is no report.
std::vector<fs::path> picturesOf(const fs::path& page) {
  std::vector<fs::path> pictures;
  std::ifstream file(page);
  for (std::string line; std::getline(file, line);) {
    // As writeGroup() puts them: ![name](file.png), on a line of its own.
    const std::size_t start = line.rfind("](");
    if (line.rfind("![", 0) == 0 && start != std::string::npos && line.back() == ')') {
      const fs::path name = line.substr(start + 2, line.size() - start - 3);
      if (name == name.filename() && name.extension() == ".png") {
        pictures.push_back(page.parent_path() / name);
      }
    }
  }
  return pictures;
}

std::ofstream openForWriting(const fs::path& path) {
  std::ofstream file(path);
  if (!file) {
    throw std::runtime_error("cannot write " + path.string());
  }
  return file;
}

void closeWritten(std::ofstream& file, const fs::path& path) {
  file.close();
  if (!file) {
    throw std::runtime_error("cannot write " + path.string());
  }
}

std::string fileNameOf(std::string name) {
  std::replace_if(
      name.begin(), name.end(),
      [](unsigned char c) { return std::isalnum(c) == 0 && c != '-' && c != '_'; }, '_');
  return name;
}

void writeCsv(const fs::path& path, const std::vector<EvaluationGroup>& groups) {
  constexpr int kDigits = 8;
  std::ofstream file = openForWriting(path);
  file << "group,recording,stamp_ns,exposure_ns,events,searched_contrast,method,runtime_ms";
  for (std::size_t i = 0; i < kMeasureCount; ++i) {
    file << "," << describe(static_cast<Measure>(i)).name;
  }
  file << "\n" << std::setprecision(kDigits);
  for (const EvaluationGroup& group : groups) {
    const std::vector<std::size_t> columns = columnsWith(group, measuresIn(group));
    for (const Evaluation* member : group.members) {
      for (const FrameFigures& frame : member->frames) {
        for (const std::size_t column : columns) {
          file << group.name << "," << member->name << "," << frame.stamp_ns << ","
               << frame.exposure_ns << "," << frame.events << "," << frame.searched_contrast << ","
               << columnName(*member, column) << "," << frame.runtime_ms[column];
          for (const std::optional<double>& score : frame.scores[column]) {
            file << ",";
            if (score) {
              file << *score;
            }
          }
          file << "\n";
        }
      }
    }
  }
  closeWritten(file, path);
}

cv::Mat examplePicture(const Evaluation& evaluation) {
  constexpr int kColumns = 3;
  constexpr int kScale = 2;
  std::vector<CaptionedPicture> pictures;
  for (const std::size_t column : columnsOf({"", {&evaluation}})) {
    pictures.push_back({columnName(evaluation, column), evaluation.example[column]});
  }
  return pictureGrid(pictures, kColumns, kScale);
}

/// One recording: values over its frames. Several: bars over them.
cv::Mat measurePicture(const EvaluationGroup& group, Measure measure) {
  const MeasureInfo& info = describe(measure);
  const PlotLabels labels = {
      group.name + ": " + info.name +
          (info.higher_is_better ? " (higher is better)" : " (lower is better)"),
      group.members.size() == 1 ? "frame" : "", nameWithUnit(info)};
  std::vector<PlotSeries> series;
  std::vector<std::string> names;
  for (const Evaluation* member : group.members) {
    names.push_back(member->name);
  }
  for (const std::size_t column : columnsWith(group, {measure})) {
    PlotSeries line = {columnName(group, column), {}};
    if (group.members.size() == 1) {
      for (const FrameFigures& frame : group.members.front()->frames) {
        line.values.push_back(frame.scores[column][indexOf(measure)]);
      }
    } else {
      for (const Evaluation* member : group.members) {
        line.values.push_back(member->mean(column, measure));
      }
    }
    series.push_back(std::move(line));
  }
  return group.members.size() == 1 ? linePlot(labels, series) : barPlot(labels, names, series);
}

void writeFrameCounts(std::ostream& out, const EvaluationGroup& group) {
  for (const Evaluation* member : group.members) {
    out << "- " << member->name << ": " << member->frames.size() << " frames compared";
    for (const auto& [reason, count] : member->left_out) {
      out << ", " << count << " left out (" << reason << ")";
    }
    out << "\n";
  }
  out << "\n";
}

void writeGroup(std::ostream& out, const fs::path& folder, const EvaluationGroup& group) {
  out << "## " << group.name << "\n\n";
  writeFrameCounts(out, group);
  printMeasureTable(out, group);
  out << "\n";
  for (const Measure measure : measuresIn(group)) {
    if (group.members.size() > 1 && (measure == Measure::kPsnr || measure == Measure::kSsim)) {
      out << nameWithUnit(describe(measure)) << ":\n\n";
      printMemberTable(out, group, measure);
      out << "\n";
    }
    const std::string file =
        fileNameOf(group.name) + "_" + fileNameOf(describe(measure).name) + ".png";
    writePicture(folder / file, measurePicture(group, measure));
    out << "![" << describe(measure).name << "](" << file << ")\n\n";
  }
  for (const Evaluation* member : group.members) {
    if (member->frames.empty()) {
      continue;
    }
    const std::string file = "example_" + fileNameOf(member->name) + ".png";
    writePicture(folder / file, examplePicture(*member));
    out << member->name << ", the frame with the most events (stamp " << member->example_stamp_ns
        << " ns):\n\n![" << member->name << "](" << file << ")\n\n";
  }
}

}  // namespace

void printMeasureTable(std::ostream& out, const EvaluationGroup& group) {
  const std::vector<Measure> measures = measuresIn(group);
  const std::vector<std::size_t> columns = columnsWith(group, measures);
  printHeader(out, "mean", group, columns);
  for (const Measure measure : measures) {
    const MeasureInfo& info = describe(measure);
    const std::optional<double> blurry = meanOver(group.members, indexOf(Method::kBlurry), measure);
    out << "| " << nameWithUnit(info) << (info.higher_is_better ? "" : ", lower is better") << " |";
    for (const std::size_t column : columns) {
      const std::optional<double> value = meanOver(group.members, column, measure);
      out << " " << cell(value, info.decimals)
          << (info.is_count && column != indexOf(Method::kBlurry) ? gainOver(value, blurry) : "")
          << " |";
    }
    out << "\n";
  }
}

void printMemberTable(std::ostream& out, const EvaluationGroup& group, Measure measure) {
  const std::vector<std::size_t> columns = columnsWith(group, {measure});
  const int decimals = describe(measure).decimals;
  printHeader(out, "recording", group, columns);
  for (const Evaluation* member : group.members) {
    out << "| " << member->name << " |";
    for (const std::size_t column : columns) {
      out << " " << cell(member->mean(column, measure), decimals) << " |";
    }
    out << "\n";
  }
  out << "| mean |";
  for (const std::size_t column : columns) {
    out << " " << cell(meanOver(group.members, column, measure), decimals) << " |";
  }
  out << "\n";
}

void printRuntimeTable(std::ostream& out, const EvaluationGroup& group) {
  constexpr int kDecimals = 2;
  out << "| run time per frame [ms] | median | worst |\n|---|---:|---:|\n";
  Evaluation all;
  for (const Evaluation* member : group.members) {
    all.frames.insert(all.frames.end(), member->frames.begin(), member->frames.end());
  }
  for (const std::size_t column : columnsOf(group)) {
    if (all.medianRuntimeMs(column) > 0.0) {
      out << "| " << columnName(group, column) << " | "
          << fixed(all.medianRuntimeMs(column), kDecimals) << " | "
          << fixed(all.maxRuntimeMs(column), kDecimals) << " |\n";
    }
  }
}

void prepareReportFolder(const std::string& folder, bool overwrite) {
  const fs::path page = fs::path(folder) / kPage;
  std::vector<fs::path> earlier = picturesOf(page);
  earlier.insert(earlier.end(), {page, fs::path(folder) / kFigures});
  for (const fs::path& path : earlier) {
    if (!overwrite && fs::exists(path)) {
      throw std::runtime_error("cannot write a report to " + folder + ": " + path.string() +
                               " exists already (--force replaces it)");
    }
  }
  for (const fs::path& path : earlier) {
    std::error_code error;
    fs::remove(path, error);
    if (error) {
      throw std::runtime_error("cannot remove " + path.string() + ": " + error.message());
    }
  }
}

std::string writeReport(const std::string& folder, const ReportText& text,
                        const std::vector<EvaluationGroup>& groups) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) {
    throw std::runtime_error("cannot create folder " + folder + ": " + error.message());
  }
  const fs::path page = fs::path(folder) / kPage;
  std::ofstream out = openForWriting(page);
  out << "# " << text.title << "\n\n";
  if (!text.command.empty()) {
    out << "Made by\n\n```\n" << text.command << "\n```\n\n";
  }
  for (const std::string& note : text.notes) {
    out << "- " << note << "\n";
  }
  out << "\n";
  EvaluationGroup all{"all", {}};
  for (const EvaluationGroup& group : groups) {
    writeGroup(out, folder, group);
    all.members.insert(all.members.end(), group.members.begin(), group.members.end());
  }
  out << "## Run time\n\nWall clock of this machine, taking in events and closing.\n\n";
  printRuntimeTable(out, all);
  closeWritten(out, page);
  writeCsv(fs::path(folder) / kFigures, groups);
  return page.string();
}

}  // namespace fast_edi
