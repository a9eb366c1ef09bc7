/// \file
/// The report of validate_bag for people, ending with lines that can be pasted into a YAML file.
#pragma once

#include <iosfwd>

#include "validation/recording_validator.hpp"

namespace fast_edi {

void printReport(std::ostream& out, const RecordingSurvey& survey, const ValidationReport& report);

/// One finding, three lines.
void printFinding(std::ostream& out, const Finding& finding);

}  // namespace fast_edi
