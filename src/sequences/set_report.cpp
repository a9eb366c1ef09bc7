#include "sequences/set_report.hpp"

#include <algorithm>
#include <fstream>
#include <iomanip>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace fast_edi {
namespace {

constexpr char kNoValue[] = "-";

struct Factor {
  const char* name;
  std::string SequenceFactors::*level;
};
constexpr std::array<Factor, 5> kFactors = {{{"sensor", &SequenceFactors::sensor},
                                             {"blur", &SequenceFactors::blur},
                                             {"light", &SequenceFactors::light},
                                             {"contrast", &SequenceFactors::contrast},
                                             {"thresholds", &SequenceFactors::thresholds}}};

std::string cell(const std::optional<double>& value, int decimals) {
  if (!value) return kNoValue;
  std::ostringstream text;
  text << std::fixed << std::setprecision(decimals) << *value;
  return text.str();
}

std::string signedCell(double value, int decimals) {
  return (value >= 0.0 ? "+" : "") + cell(value, decimals);
}

/// Gains of a column over another one, over the sequences that have both.
struct Gain {
  double sum = 0.0;
  double worst = std::numeric_limits<double>::infinity();
  int count = 0;

  std::string text(int decimals) const {
    if (count == 0) return kNoValue;
    return signedCell(sum / count, decimals) + " (" + signedCell(worst, decimals) + ")";
  }
};

using Members = std::vector<const SetResult*>;

Gain gainOf(const Members& members, std::size_t column, std::size_t base, Measure measure) {
  Gain gain;
  for (const SetResult* member : members) {
    const auto value = member->mean(column, measure);
    const auto other = member->mean(base, measure);
    if (!value || !other) continue;
    gain.sum += *value - *other;
    gain.worst = std::min(gain.worst, *value - *other);
    ++gain.count;
  }
  return gain;
}

std::optional<double> meanOver(const Members& members, std::size_t column, Measure measure) {
  double sum = 0.0;
  int count = 0;
  for (const SetResult* member : members) {
    if (const auto value = member->mean(column, measure)) {
      sum += *value;
      ++count;
    }
  }
  return count > 0 ? std::optional<double>(sum / count) : std::nullopt;
}

Members all(const SetEvaluation& evaluation) {
  Members members;
  for (const SetResult& result : evaluation.results) members.push_back(&result);
  return members;
}

/// Levels of a factor in the order of their first sequence.
std::vector<std::pair<std::string, Members>> byLevel(const SetEvaluation& evaluation,
                                                     const Factor& factor) {
  std::vector<std::pair<std::string, Members>> levels;
  for (const SetResult& result : evaluation.results) {
    const std::string& level = result.factors.*factor.level;
    auto found = std::find_if(levels.begin(), levels.end(),
                              [&](const auto& entry) { return entry.first == level; });
    if (found == levels.end()) {
      levels.push_back({level, {}});
      found = std::prev(levels.end());
    }
    found->second.push_back(&result);
  }
  return levels;
}

void printHeader(std::ostream& out, const std::vector<std::string>& texts, std::size_t numbers) {
  out << "|";
  for (const std::string& text : texts) out << " " << text << " |";
  out << "\n|";
  for (std::size_t i = 0; i < texts.size(); ++i) {
    out << (i + numbers < texts.size() ? "---|" : "---:|");
  }
  out << "\n";
}

void printFactorRow(std::ostream& out, const std::string& name, const Members& members,
                    std::size_t column) {
  const int psnr = describe(Measure::kPsnr).decimals;
  const int ssim = describe(Measure::kSsim).decimals;
  out << "| " << name << " | " << members.size() << " | "
      << cell(meanOver(members, column, Measure::kPsnr), psnr) << " | "
      << gainOf(members, column, kPlainColumn, Measure::kPsnr).text(psnr) << " | "
      << gainOf(members, column, kBlurryColumn, Measure::kPsnr).text(psnr) << " | "
      << cell(meanOver(members, column, Measure::kSsim), ssim) << " | "
      << gainOf(members, column, kPlainColumn, Measure::kSsim).text(ssim) << " | "
      << gainOf(members, column, kBlurryColumn, Measure::kSsim).text(ssim) << " |\n";
}

/// The largest mean of some columns.
std::optional<double> bestOf(const SetResult& result, const std::vector<std::size_t>& columns,
                             Measure measure) {
  std::optional<double> best;
  for (const std::size_t column : columns) {
    best = std::max(best, result.mean(column, measure));
  }
  return best;
}

/// "97 % (92 %)": a column over the best of others, mean and worst.
std::string shareText(const SetEvaluation& evaluation, std::size_t column,
                      const std::vector<std::size_t>& others, Measure measure) {
  constexpr double kPercent = 100.0;
  double sum = 0.0;
  double worst = std::numeric_limits<double>::infinity();
  int count = 0;
  // The age is no count.
  const double least = describe(measure).is_count ? kLeastToCompare : 0.0;
  for (const SetResult& result : evaluation.results) {
    const auto value = result.mean(column, measure);
    const auto other = bestOf(result, others, measure);
    if (!value || !other || *other <= 0.0 || *other < least) continue;
    const double share = kPercent * *value / *other;
    sum += share;
    worst = std::min(worst, share);
    ++count;
  }
  if (count == 0) return kNoValue;
  return cell(sum / count, 0) + " % (" + cell(worst, 0) + " %)";
}

std::size_t truthColumn(const SetEvaluation& evaluation) {
  return evaluation.columns.size() - 1;
}

}  // namespace

void printSetMembers(std::ostream& out, const SetEvaluation& evaluation, Measure measure) {
  const int decimals = describe(measure).decimals;
  std::vector<std::string> header = {std::string(describe(measure).name) + " of"};
  for (const Factor& factor : kFactors) header.emplace_back(factor.name);
  header.insert(header.end(), evaluation.columns.begin(), evaluation.columns.end());
  printHeader(out, header, evaluation.columns.size());
  for (const SetResult& result : evaluation.results) {
    out << "| " << result.name << " |";
    for (const Factor& factor : kFactors) out << " " << result.factors.*factor.level << " |";
    for (std::size_t column = 0; column < evaluation.columns.size(); ++column) {
      out << " " << cell(result.mean(column, measure), decimals) << " |";
    }
    out << "\n";
  }
  out << "| mean |";
  for (std::size_t i = 0; i < kFactors.size(); ++i) out << " |";
  for (std::size_t column = 0; column < evaluation.columns.size(); ++column) {
    out << " " << cell(meanOver(all(evaluation), column, measure), decimals) << " |";
  }
  out << "\n";
}

void printSetFactors(std::ostream& out, const SetEvaluation& evaluation) {
  for (std::size_t column = kFirstVariantColumn; column < truthColumn(evaluation); ++column) {
    printHeader(out,
                {evaluation.columns[column], "sequences", "PSNR [dB]", "over plain EDI (worst)",
                 "over blurry (worst)", "SSIM", "over plain EDI (worst)", "over blurry (worst)"},
                7);
    for (const Factor& factor : kFactors) {
      for (const auto& [level, members] : byLevel(evaluation, factor)) {
        printFactorRow(out, std::string(factor.name) + ": " + level, members, column);
      }
    }
    printFactorRow(out, "all", all(evaluation), column);
    out << "\n";
  }
}

void printSetShares(std::ostream& out, const SetEvaluation& evaluation) {
  const std::size_t truth = truthColumn(evaluation);
  for (std::size_t column = kFirstVariantColumn; column <= truth; ++column) {
    printHeader(out,
                {evaluation.columns[column], "of the better of plain EDI and blurry (worst)",
                 "of plain EDI (worst)", "of the true frames (worst)"},
                3);
    for (std::size_t i = indexOf(Measure::kSurf); i < kMeasureCount; ++i) {
      const auto measure = static_cast<Measure>(i);
      if (!meanOver(all(evaluation), column, measure)) continue;
      out << "| " << describe(measure).name << " | "
          << shareText(evaluation, column, {kPlainColumn, kBlurryColumn}, measure) << " | "
          << shareText(evaluation, column, {kPlainColumn}, measure) << " | "
          << shareText(evaluation, column, {truth}, measure) << " |\n";
    }
    out << "\n";
  }
}

void printSetMeasures(std::ostream& out, const SetEvaluation& evaluation) {
  std::vector<std::string> header = {"mean over sequences"};
  header.insert(header.end(), evaluation.columns.begin(), evaluation.columns.end());
  printHeader(out, header, evaluation.columns.size());
  const Members members = all(evaluation);
  for (std::size_t i = 0; i < kMeasureCount; ++i) {
    const auto measure = static_cast<Measure>(i);
    if (!meanOver(members, kBlurryColumn, measure)) continue;
    const MeasureInfo& info = describe(measure);
    out << "| " << info.name << (info.unit[0] != '\0' ? std::string(" [") + info.unit + "]" : "")
        << (info.higher_is_better ? "" : ", lower is better") << " |";
    for (std::size_t column = 0; column < evaluation.columns.size(); ++column) {
      out << " " << cell(meanOver(members, column, measure), info.decimals) << " |";
    }
    out << "\n";
  }
}

void printSetRuntimes(std::ostream& out, const SetEvaluation& evaluation) {
  constexpr int kDecimals = 2;
  out << "Median time for a frame [ms]:";
  for (std::size_t column = kPlainColumn; column < truthColumn(evaluation); ++column) {
    std::vector<double> times;
    for (const SetResult& result : evaluation.results) {
      const std::vector<double>& own = result.runtime_ms[column];
      times.insert(times.end(), own.begin(), own.end());
    }
    if (times.empty()) continue;
    const auto middle = times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2);
    std::nth_element(times.begin(), middle, times.end());
    out << (column > kPlainColumn ? "; " : " ") << evaluation.columns[column] << " "
        << cell(*middle, kDecimals);
  }
  out << "\n";
}

void writeSetScores(const std::string& path, const SetEvaluation& evaluation) {
  constexpr int kDigits = 8;
  std::ofstream file(path);
  file << "sequence";
  for (const Factor& factor : kFactors) file << "," << factor.name;
  file << ",frame,method,runtime_ms";
  for (std::size_t i = 0; i < kMeasureCount; ++i) {
    file << "," << describe(static_cast<Measure>(i)).name;
  }
  file << "\n" << std::setprecision(kDigits);
  for (const SetResult& result : evaluation.results) {
    for (std::size_t column = 0; column < evaluation.columns.size(); ++column) {
      for (std::size_t frame = 0; frame < result.scores[column].size(); ++frame) {
        file << result.name;
        for (const Factor& factor : kFactors) file << "," << result.factors.*factor.level;
        file << "," << frame << "," << evaluation.columns[column] << ","
             << result.runtime_ms[column][frame];
        for (const std::optional<double>& score : result.scores[column][frame]) {
          file << ",";
          if (score) file << *score;
        }
        file << "\n";
      }
    }
  }
  file.close();
  if (!file) {
    throw std::runtime_error("cannot write " + path);
  }
}

}  // namespace fast_edi
