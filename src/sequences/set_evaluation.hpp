/// \file
/// Variants of the package's parameters, compared on the same simulated input: blurry frames, plain
/// EDI, every variant, and the true frames.
#pragma once

#include <array>
#include <functional>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "fast_edi/parameters/parameters.hpp"
#include "measures/frame_scorer.hpp"
#include "sequences/sequence_sets.hpp"

namespace fast_edi {

struct Variant {
  std::string name;  ///< for tables
  DeblurParameters parameters;
};

/// What every comparison has beside its variants.
constexpr std::size_t kBlurryColumn = 0;
constexpr std::size_t kPlainColumn = 1;
constexpr std::size_t kFirstVariantColumn = 2;

/// Scores of one sequence.
struct SetResult {
  std::string name;
  SequenceFactors factors;
  std::vector<std::vector<Scores>> scores;      ///< [column][frame]
  std::vector<std::vector<double>> runtime_ms;  ///< [column][frame], 0 for images not computed
  int left_out = 0;                             ///< frames that were passed through

  /// Mean over the frames that have the measure.
  std::optional<double> mean(std::size_t column, Measure measure) const;
};

struct SetEvaluation {
  std::vector<std::string> columns;  ///< blurry, plain EDI, the variants, the true frames
  std::vector<SetResult> results;
};

/// "blurry", "plain EDI", the variants' names, "true frames".
std::vector<std::string> columnNames(const std::vector<Variant>& variants);

/// Simulates a sequence once and gives it to plain EDI and to all variants.
/// \param variants their thresholds and exposure are replaced by the simulated sensor's, thresholds
///        times the sequence's factor; latent images show mid-exposure
/// \param progress called after each frame with the number of frames done
SetResult evaluateVariants(const SetSequence& sequence, const std::vector<Variant>& variants,
                           const FrameScorer& scorer, const std::function<void(int)>& progress);

}  // namespace fast_edi
