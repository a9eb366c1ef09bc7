/// \file
/// Two sets of simulated sequences over many sensors, fixed before anything was tuned on either.
///
/// **Choosing**: filters, models and their parameters may be chosen on it, as often as one likes.
/// **Judging**: measures the choice on a camera and a scene that were not used for it.
/// Its textures, photographs and seeds occur nowhere else, and its figures are never a reason for a
/// change of a parameter: who tunes on it destroys it.
///
/// Each set spreads over sensor models (sensor_models.hpp; event delays of 0 to 5 ms; hot pixels in
/// pairs, blocks, rows and a column; lamps that flicker), textures, motions, exposures of 5 to 60
/// ms, thresholds of 0.15 to 0.45, given thresholds that are wrong by up to 20 %, frame noise and
/// saturation. Photographs come from Debian's package mate-backgrounds; without it their sequences
/// are left out, and named.
#pragma once

#include <string>
#include <vector>

#include "sequences/sequences.hpp"

namespace fast_edi {

enum class SequenceSet {
  kTwelve,    ///< evaluationSequences(), see there
  kChoosing,  ///< to choose by
  kJudging,   ///< to judge by, never to choose
};

/// \throws std::invalid_argument listing the names that are known: twelve, choosing, judging
SequenceSet sequenceSetFromName(const std::string& name);

/// What a sequence is an example of; each is one of a few words.
struct SequenceFactors {
  std::string sensor;    ///< a sensor model, or "delay", "hot", "flicker"
  std::string blur;      ///< mean path of the image in an exposure: "< 3 px", "3-10 px", "> 10 px"
  std::string light;     ///< "bright", "dim", "saturated"
  std::string contrast;  ///< of the texture: "full", "faint"
  std::string thresholds;  ///< as given to the methods: "right", "wrong"
};

struct SetSequence {
  EvaluationSequence sequence;
  SequenceFactors factors;
  double threshold_factor = 1.0;  ///< given thresholds over true ones
};

struct SequenceSetContents {
  std::vector<SetSequence> sequences;
  std::vector<std::string> missing;  ///< each: what is left out, and the package that it needs
};

constexpr int kSetFrames = 6;
/// Where Debian's packages put their pictures.
constexpr const char* kPhotographFolder = "/usr/share/backgrounds";

/// \param set kChoosing or kJudging
/// \param frames of each sequence, >= 1
/// \param photographs folder that holds mate/nature/*.jpg of Debian's mate-backgrounds
/// \throws std::invalid_argument otherwise
SequenceSetContents sequencesOf(SequenceSet set, int frames = kSetFrames,
                                const std::string& photographs = kPhotographFolder);

}  // namespace fast_edi
