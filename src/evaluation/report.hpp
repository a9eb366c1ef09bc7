/// \file
/// The report of an evaluation: a Markdown page with tables and pictures, and all figures as CSV.
///
/// Run times are apart from everything else: those depend on the machine, the rest repeats digit by
/// digit for the same input and seed.
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "evaluation/evaluation.hpp"

namespace fast_edi {

/// Evaluations that are told together: all of a set, or its half that was not tuned on.
struct EvaluationGroup {
  std::string name;
  std::vector<const Evaluation*> members;
};

/// Measures as rows, methods as columns; each value the mean over the members' means. Counts come
/// with their gain over the blurry input in percent.
void printMeasureTable(std::ostream& out, const EvaluationGroup& group);

/// One measure: members as rows, methods as columns, and the mean.
void printMemberTable(std::ostream& out, const EvaluationGroup& group, Measure measure);

/// Median and worst run time per frame of each method [ms], over all members' frames.
void printRuntimeTable(std::ostream& out, const EvaluationGroup& group);

struct ReportText {
  std::string title;
  std::string command;  ///< how the report was made
  std::vector<std::string>
      notes;  ///< what the reader must know, e.g. measures that are not available
};

/// Makes room for a report, so that no folder holds parts of two.
/// \param overwrite remove the report that is there: report.md, the pictures that it shows, and
///        figures.csv
/// \throws std::runtime_error when there is one that is not to be replaced, or cannot be removed
void prepareReportFolder(const std::string& folder, bool overwrite);

/// Writes report.md, figures.csv and PNG pictures into \p folder, which is created when missing.
/// Members are shown one by one when a group has more than one.
/// \return the path of report.md
/// \throws std::runtime_error naming the file that cannot be written
std::string writeReport(const std::string& folder, const ReportText& text,
                        const std::vector<EvaluationGroup>& groups);

}  // namespace fast_edi
