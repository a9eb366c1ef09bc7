/// \file
/// All measures of one frame, by those parts of the evaluation that this machine has.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "fast_edi/tags/tag_detector.hpp"
#include "measures/brisque.hpp"
#include "measures/feature_matches.hpp"
#include "measures/feature_tracks.hpp"
#include "measures/frame_choice.hpp"
#include "measures/sseq.hpp"

namespace fast_edi {

/// What is measured, in the order of reports.
enum class Measure {
  kPsnr,
  kSsim,
  kPiqe,
  kBrisque,
  kSseq,
  kSharpness,  ///< Sharpness::tenengrad_above_noise
  kTags,       ///< AprilTags found
  kSurf,       ///< from here on: inliers between this frame and the one before
  kFastBrisk,
  kMserSurf,
  kMserOrb,
  kBrisk,
  kOrb,
  kTrueNextSurf,  ///< from here on: inliers between the frame before and this *true* frame, which
                  ///< noise in both pictures cannot raise
  kTrueNextFastBrisk,
  kTrueNextMserSurf,
  kTrueNextMserOrb,
  kTrueNextBrisk,
  kTrueNextOrb,
  kTracksClose,  ///< TrackFigures::tracks, features 10 px apart
  kTracksWide,   ///< the same, 20 px apart
  kTrackAge,     ///< TrackFigures::mean_age, 10 px apart [frames]
  kMovedShare,   ///< TrackFigures::moved_share, 10 px apart
};
constexpr std::size_t kMeasureCount = 23;
constexpr std::size_t indexOf(Measure measure) {
  return static_cast<std::size_t>(measure);
}

struct MeasureInfo {
  const char* name;
  const char* unit;       ///< empty for a number without one
  bool higher_is_better;  ///< false: lower is better
  bool is_count;          ///< tags and inliers: gains are told in percent
  int decimals;
};
const MeasureInfo& describe(Measure measure);

/// Distance of tracked features [px].
constexpr double kCloseTracksPx = 10.0;
constexpr double kWideTracksPx = 20.0;

/// No value: no truth, no previous frame, or not available on this machine.
using Scores = std::array<std::optional<double>, kMeasureCount>;

/// How much is measured; each includes those before it.
enum class MeasureExtent {
  kReference,  ///< PSNR and SSIM alone: fast
  kTracks,     ///< what a tracker keeps
  kFrontEnd,   ///< feature inliers
  kAll,
};

/// \throws std::invalid_argument listing the names that are known: reference, tracks, front-end,
/// all
MeasureExtent measureExtentFromName(const std::string& name);

struct ScorerOptions {
  std::string brisque_model_file = kBrisqueModelFile;
  std::string brisque_range_file = kBrisqueRangeFile;
  std::string sseq_folder;  ///< empty: no SSEQ
  MeasureExtent extent = MeasureExtent::kAll;
  int first_frames_unscored = 0;  ///< of each recording: time to learn from it
  FrameChoice scored;             ///< of each recording
};

/// Of one image, by kAllFeatureMethods.
using FrameFeatures = std::array<ImageFeatures, kAllFeatureMethods.size()>;

/// The true frame, and what is needed of it for each method.
struct TrueFrame {
  cv::Mat image;           ///< CV_8UC1, or empty: not known
  FrameFeatures features;  ///< without MeasureExtent::kFrontEnd none
};

/// Features and tracks of the frames before, one memory for each method. clear() where a frame is
/// missing.
class FeatureMemory {
 public:
  void clear();

 private:
  friend class FrameScorer;
  bool known_ = false;
  FrameFeatures features_;
  FeatureTracker close_{{TrackerSettings().max_features, kCloseTracksPx}};
  FeatureTracker wide_{{TrackerSettings().max_features, kWideTracksPx}};
};

class FrameScorer {
 public:
  /// \throws std::runtime_error when a given SSEQ model cannot be read
  explicit FrameScorer(const ScorerOptions& options);

  /// Measures that are not available, each with its reason: "SSEQ: no model folder was given".
  const std::vector<std::string>& missing() const { return missing_; }

  const ScorerOptions& options() const { return options_; }

  /// \param image CV_8UC1, or empty
  TrueFrame trueFrame(const cv::Mat& image) const;

  /// \param image CV_8UC1
  /// \param truth of the same size, or empty
  Scores score(const cv::Mat& image, const TrueFrame& truth, FeatureMemory& memory) const;

 private:
  bool measures(MeasureExtent extent) const { return options_.extent >= extent; }
  FrameFeatures featuresOf(const cv::Mat& image) const;
  void scoreAppearance(const cv::Mat& image, Scores& scores) const;
  void scoreFeatures(const cv::Mat& image, const TrueFrame& truth, FeatureMemory& memory,
                     Scores& scores) const;

  ScorerOptions options_;
  std::vector<std::string> missing_;
  bool have_ssim_ = true;
  std::optional<Brisque> brisque_;
  std::optional<Sseq> sseq_;
  TagDetector tag_detector_;
};

}  // namespace fast_edi
