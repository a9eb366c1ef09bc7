/// \file
/// The fixed set of simulated sequences on which methods are compared. Scenes, noise and mismatch
/// must not change with a method.
///
/// Six scenes, each with two seeds (a seed determines texture, path, thresholds and noise):
///
/// | scene               | texture      | motion | light | for tuning |
/// |---------------------|--------------|--------|-------|------------|
/// | poster-strong       | rich         | strong | bright | yes |
/// | poster-mild-dim     | rich         | mild   | dim    | yes |
/// | sparse-sweep        | nearly empty | strong | bright | yes |
/// | mosaic-strong-dim   | rich         | strong | dim    | no  |
/// | mosaic-mild         | rich         | mild   | bright | no  |
/// | page-spin           | dark on calm | strong | bright | no  |
///
/// Textures of the second half (stones with joints; a printed page) are of kinds on which nothing
/// was tuned. All of them: a DAVIS346 with libcaer's biases, threshold mismatch 8 %, refractory
/// period 3.4 us, leak 0.1 Hz, shot noise 0.5 (bright) to 5 Hz (dark), photoreceptor 300 (bright)
/// to 30 Hz (dark), frames every 40 ms with 1.5 DN read noise and shot noise. Exposures last 20 to
/// 30 ms. Dim: a quarter of the light at twice the gain, 2 DN read noise.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "evaluation/contrast_search.hpp"
#include "evaluation/evaluation.hpp"
#include "fast_edi/parameters/parameters.hpp"
#include "scenes/simulation_settings.hpp"

namespace fast_edi {

struct EvaluationSequence {
  std::string name;        ///< "poster-strong/1"
  bool for_tuning = true;  ///< false: its texture must not be used to choose parameters
  SimulationSettings settings;
};

constexpr int kSequenceFrames = 10;
constexpr int kSequenceSeeds = 2;

/// \param frames of each sequence, \param seeds of each scene, from 1; both >= 1
/// \throws std::invalid_argument otherwise
std::vector<EvaluationSequence> evaluationSequences(int frames = kSequenceFrames,
                                                    int seeds = kSequenceSeeds);

/// Simulates a sequence and compares the methods on it.
/// \param parameters of the variant under evaluation; thresholds and exposure are those of the
///        simulated sensor, thresholds times \p threshold_factor
/// \param others further methods
/// \param progress called after each frame with the number of frames done
Evaluation evaluateSequence(const EvaluationSequence& sequence, const DeblurParameters& parameters,
                            double threshold_factor, const ContrastSearchOptions& search,
                            const FrameScorer& scorer, const OtherMethods& others,
                            const std::function<void(int)>& progress);

}  // namespace fast_edi
