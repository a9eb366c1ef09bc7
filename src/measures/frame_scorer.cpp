#include "measures/frame_scorer.hpp"

#include <stdexcept>
#include <utility>

#include "measures/capability.hpp"
#include "measures/image_metrics.hpp"
#include "measures/piqe.hpp"

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
    {"inliers with true next SURF", "", true, true, 1},
    {"inliers with true next FAST+BRISK", "", true, true, 1},
    {"inliers with true next MSER+SURF", "", true, true, 1},
    {"inliers with true next MSER+ORB", "", true, true, 1},
    {"inliers with true next BRISK", "", true, true, 1},
    {"inliers with true next ORB", "", true, true, 1},
    {"tracks 10 px apart", "", true, true, 1},
    {"tracks 20 px apart", "", true, true, 1},
    {"age of tracks", "frames", true, false, 2},
    {"tracks that moved with the scene", "", true, false, 3},
}};

/// \param first kSurf or kTrueNextSurf
std::size_t indexFrom(Measure first, FeatureMethod method) {
  return indexOf(first) + static_cast<std::size_t>(method);
}

void scoreTracks(const cv::Mat& image, FeatureTracker& close, FeatureTracker& wide,
                 Scores& scores) {
  if (const auto figures = close.track(image)) {
    scores[indexOf(Measure::kTracksClose)] = figures->tracks;
    scores[indexOf(Measure::kTrackAge)] = figures->mean_age;
    scores[indexOf(Measure::kMovedShare)] = figures->moved_share;
  }
  if (const auto figures = wide.track(image)) {
    scores[indexOf(Measure::kTracksWide)] = figures->tracks;
  }
}

std::string absence(const std::string& measure, OptionalLibrary library) {
  return measure + ": " + toString(library) + " was not found when this program was built";
}

}  // namespace

const MeasureInfo& describe(Measure measure) {
  return kMeasures[indexOf(measure)];
}

MeasureExtent measureExtentFromName(const std::string& name) {
  if (name == "reference") return MeasureExtent::kReference;
  if (name == "tracks") return MeasureExtent::kTracks;
  if (name == "front-end") return MeasureExtent::kFrontEnd;
  if (name == "all") return MeasureExtent::kAll;
  throw std::invalid_argument(
      "measures: expected one of reference, tracks, front-end, all, got \"" + name + "\"");
}

void FeatureMemory::clear() {
  known_ = false;
  close_.clear();
  wide_.clear();
}

FrameScorer::FrameScorer(const ScorerOptions& options) : options_(options) {
  if (!isAvailable(OptionalLibrary::kOpencvQuality)) {
    have_ssim_ = false;
    missing_.push_back(absence("SSIM", OptionalLibrary::kOpencvQuality));
  }
  if (options.extent < MeasureExtent::kAll) {
    missing_.push_back("measures that were not asked for");
  }
  if (measures(MeasureExtent::kFrontEnd) && !isAvailable(OptionalLibrary::kDlib)) {
    missing_.push_back(absence("inliers SURF and MSER+SURF", OptionalLibrary::kDlib));
  }
  if (!measures(MeasureExtent::kAll)) {
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
}

TrueFrame FrameScorer::trueFrame(const cv::Mat& image) const {
  TrueFrame truth;
  truth.image = image;
  if (!image.empty() && measures(MeasureExtent::kFrontEnd)) {
    truth.features = featuresOf(image);
  }
  return truth;
}

Scores FrameScorer::score(const cv::Mat& image, const TrueFrame& truth,
                          FeatureMemory& memory) const {
  Scores scores;
  if (!truth.image.empty()) {
    scores[indexOf(Measure::kPsnr)] = psnr(image, truth.image);
    if (have_ssim_) {
      scores[indexOf(Measure::kSsim)] = ssim(image, truth.image);
    }
  }
  if (measures(MeasureExtent::kTracks)) {
    scoreTracks(image, memory.close_, memory.wide_, scores);
  }
  if (measures(MeasureExtent::kFrontEnd)) {
    scoreFeatures(image, truth, memory, scores);
  }
  if (measures(MeasureExtent::kAll)) {
    scoreAppearance(image, scores);
  }
  return scores;
}

void FrameScorer::scoreAppearance(const cv::Mat& image, Scores& scores) const {
  scores[indexOf(Measure::kPiqe)] = piqe(image).score;
  if (brisque_) {
    scores[indexOf(Measure::kBrisque)] = brisque_->score(image);
  }
  if (sseq_) {
    scores[indexOf(Measure::kSseq)] = sseq_->score(image);
  }
  scores[indexOf(Measure::kSharpness)] = sharpness(image).tenengrad_above_noise;
  scores[indexOf(Measure::kTags)] = static_cast<double>(tag_detector_.detect(image).size());
}

FrameFeatures FrameScorer::featuresOf(const cv::Mat& image) const {
  FrameFeatures features;
  for (std::size_t i = 0; i < kAllFeatureMethods.size(); ++i) {
    const FeatureMethod method = kAllFeatureMethods[i];
    if (!needsDlib(method) || isAvailable(OptionalLibrary::kDlib)) {
      features[i] = findFeatures(image, method);
    }
  }
  return features;
}

void FrameScorer::scoreFeatures(const cv::Mat& image, const TrueFrame& truth, FeatureMemory& memory,
                                Scores& scores) const {
  FrameFeatures features = featuresOf(image);
  for (std::size_t i = 0; memory.known_ && i < kAllFeatureMethods.size(); ++i) {
    const FeatureMethod method = kAllFeatureMethods[i];
    if (needsDlib(method) && !isAvailable(OptionalLibrary::kDlib)) {
      continue;
    }
    const ImageFeatures& before = memory.features_[i];
    scores[indexFrom(Measure::kSurf, method)] = matchFeatures(before, features[i]).inliers;
    if (!truth.image.empty()) {
      scores[indexFrom(Measure::kTrueNextSurf, method)] =
          matchFeatures(before, truth.features[i]).inliers;
    }
  }
  memory.features_ = std::move(features);
  memory.known_ = true;
}

}  // namespace fast_edi
