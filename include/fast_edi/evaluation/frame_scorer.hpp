/// \file
/// All measures of one frame, by those parts of the evaluation that this machine has.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "fast_edi/evaluation/brisque.hpp"
#include "fast_edi/evaluation/feature_matches.hpp"
#include "fast_edi/evaluation/sseq.hpp"
#include "fast_edi/tags/tag_detector.hpp"

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
};
constexpr std::size_t kMeasureCount = 13;
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

/// No value: no truth, no frame before, or not to be had on this machine.
using Scores = std::array<std::optional<double>, kMeasureCount>;

struct ScorerOptions {
  std::string brisque_model_file = kBrisqueModelFile;
  std::string brisque_range_file = kBrisqueRangeFile;
  std::string sseq_folder;           ///< empty: no SSEQ
  bool full_reference_only = false;  ///< PSNR and SSIM alone: fast, for tuning
  int first_frames_unscored = 0;     ///< of each recording: time to learn from it
};

/// Features of the frame before, one memory for each method. clear() where a frame is missing.
class FeatureMemory {
 public:
  void clear() { known_ = false; }

 private:
  friend class FrameScorer;
  bool known_ = false;
  std::array<ImageFeatures, kAllFeatureMethods.size()> features_;
};

class FrameScorer {
 public:
  /// \throws std::runtime_error when a given SSEQ model cannot be read
  explicit FrameScorer(const ScorerOptions& options);

  /// Measures that are not to be had, each with its reason: "SSEQ: no model folder was given".
  const std::vector<std::string>& missing() const { return missing_; }

  const ScorerOptions& options() const { return options_; }

  /// \param image CV_8UC1
  /// \param truth CV_8UC1 of the same size, or empty
  Scores score(const cv::Mat& image, const cv::Mat& truth, FeatureMemory& memory) const;

 private:
  void scoreWithoutReference(const cv::Mat& image, FeatureMemory& memory, Scores& scores) const;

  ScorerOptions options_;
  std::vector<std::string> missing_;
  bool have_ssim_ = true;
  std::optional<Brisque> brisque_;
  std::optional<Sseq> sseq_;
  TagDetector tag_detector_;
};

}  // namespace fast_edi
