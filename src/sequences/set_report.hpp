/// \file
/// Tables of a set's evaluation. A gain is the difference to another column of the same sequence;
/// means count each sequence the same, "worst" is the sequence with the smallest gain.
#pragma once

#include <iosfwd>
#include <string>

#include "sequences/set_evaluation.hpp"

namespace fast_edi {

/// Sequences as rows with their factors, columns as columns.
void printSetMembers(std::ostream& out, const SetEvaluation& evaluation, Measure measure);

/// For each variant: mean and worst gain over plain EDI and over the blurry frame, by each level of
/// each factor and over all; PSNR and SSIM.
void printSetFactors(std::ostream& out, const SetEvaluation& evaluation);

/// For each variant, and for the true frames themselves: what a front end keeps (tracks, their age,
/// feature inliers), as shares of what it keeps of the better of plain EDI and the blurry frames,
/// of plain EDI, and of the true frames: mean over the sequences and worst. A sequence counts where
/// the other has kLeastToCompare or more.
void printSetShares(std::ostream& out, const SetEvaluation& evaluation);
constexpr double kLeastToCompare = 10.0;

/// Means over the sequences of every measure, columns as columns.
void printSetMeasures(std::ostream& out, const SetEvaluation& evaluation);

/// Median time for a frame of each column that is computed [ms], over all frames.
void printSetRuntimes(std::ostream& out, const SetEvaluation& evaluation);

/// Every score of every frame as CSV.
/// \throws std::runtime_error naming the file that cannot be written
void writeSetScores(const std::string& path, const SetEvaluation& evaluation);

}  // namespace fast_edi
