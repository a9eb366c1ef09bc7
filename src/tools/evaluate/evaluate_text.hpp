/// \file
/// What `evaluate` prints.
#pragma once

#include <string>
#include <vector>

#include "evaluation/report.hpp"
#include "measures/frame_scorer.hpp"

namespace fast_edi::evaluate {

/// Four significant digits.
std::string decimal(double value);

/// Which measures could not be taken, and why.
std::vector<std::string> notesOf(const FrameScorer& scorer);

/// The tables of a report, on standard output.
void printGroups(const std::vector<EvaluationGroup>& groups, const std::vector<std::string>& notes);

}  // namespace fast_edi::evaluate
