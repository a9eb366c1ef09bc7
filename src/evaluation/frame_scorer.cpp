#include "fast_edi/evaluation/frame_scorer.hpp"

#include <stdexcept>

#include "fast_edi/evaluation/capability.hpp"
#include "fast_edi/evaluation/image_metrics.hpp"
#include "fast_edi/evaluation/piqe.hpp"

namespace fast_edi {
namespace {

constexpr std::array<MeasureInfo, kMeasureCount> kMeasures = {{
    {"PSNR", "dB", true, false, 2},
    {"SSIM", "", true, false, 4},
    {"PIQE", "", false, false, 2},
    {"BRISQUE", "", false, false, 2},
    {"SSEQ", "", false, false, 2},
    {"sharpness above noise", "DN^2/px^2", true, false, 1},
    {"AprilTags per frame", "", true, true, 2},
    {"inliers SURF", "", true, true, 1},
    {"inliers FAST+BRISK", "", true, true, 1},
    {"inliers MSER+SURF", "", true, true, 1},
    {"inliers MSER+ORB", "", true, true, 1},
    {"inliers BRISK", "", true, true, 1},
    {"inliers ORB", "", true, true, 1},
}};

Measure measureOf(FeatureMethod method) {
  return static_cast<Measure>(static_cast<int>(Measure::kSurf) + static_cast<int>(method));
}

std::string absence(const std::string& measure, OptionalLibrary library) {
  return measure + ": " + toString(library) + " was not found when this program was built";
}

}  // namespace

const MeasureInfo& describe(Measure measure) {
  return kMeasures[indexOf(measure)];
}

FrameScorer::FrameScorer(const ScorerOptions& options) : options_(options) {
  if (!isAvailable(OptionalLibrary::kOpencvQuality)) {
    have_ssim_ = false;
    missing_.push_back(absence("SSIM", OptionalLibrary::kOpencvQuality));
  }
  if (options.full_reference_only) {
    missing_.push_back("all measures that need no truth: not asked for");
    return;
  }
  try {
    brisque_.emplace(options.brisque_model_file, options.brisque_range_file);
  } catch (const std::runtime_error& error) {
    missing_.push_back(error.what());
  }
  if (options.sseq_folder.empty()) {
    missing_.push_back("SSEQ: no model folder was given");
  } else {
    try {
      sseq_.emplace(options.sseq_folder);
    } catch (const UnavailableError& error) {
      missing_.push_back(error.what());
    }
  }
  if (!isAvailable(OptionalLibrary::kDlib)) {
    missing_.push_back(absence("inliers SURF and MSER+SURF", OptionalLibrary::kDlib));
  }
}

Scores FrameScorer::score(const cv::Mat& image, const cv::Mat& truth, FeatureMemory& memory) const {
  Scores scores;
  if (!truth.empty()) {
    scores[indexOf(Measure::kPsnr)] = psnr(image, truth);
    if (have_ssim_) {
      scores[indexOf(Measure::kSsim)] = ssim(image, truth);
    }
  }
  if (!options_.full_reference_only) {
    scoreWithoutReference(image, memory, scores);
  }
  return scores;
}

void FrameScorer::scoreWithoutReference(const cv::Mat& image, FeatureMemory& memory,
                                        Scores& scores) const {
  scores[indexOf(Measure::kPiqe)] = piqe(image).score;
  if (brisque_) {
    scores[indexOf(Measure::kBrisque)] = brisque_->score(image);
  }
  if (sseq_) {
    scores[indexOf(Measure::kSseq)] = sseq_->score(image);
  }
  scores[indexOf(Measure::kSharpness)] = sharpness(image).tenengrad_above_noise;
  scores[indexOf(Measure::kTags)] = static_cast<double>(tag_detector_.detect(image).size());
  for (std::size_t i = 0; i < kAllFeatureMethods.size(); ++i) {
    const FeatureMethod method = kAllFeatureMethods[i];
    if (needsDlib(method) && !isAvailable(OptionalLibrary::kDlib)) {
      continue;
    }
    ImageFeatures features = findFeatures(image, method);
    if (memory.known_) {
      scores[indexOf(measureOf(method))] = matchFeatures(memory.features_[i], features).inliers;
    }
    memory.features_[i] = std::move(features);
  }
  memory.known_ = true;
}

}  // namespace fast_edi
