/// \file
/// The figures of an evaluation: frames x methods x measures, and what is told of them.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "evaluation/method_comparison.hpp"
#include "fast_edi/base/types.hpp"
#include "measures/frame_scorer.hpp"

namespace fast_edi {

struct FrameFigures {
  std::int64_t stamp_ns = 0;
  std::int64_t exposure_ns = 0;
  std::uint64_t events = 0;
  double searched_contrast = 0.0;  ///< [natural log]
  std::array<Scores, kMethodCount> scores;
  std::array<double, kMethodCount> runtime_ms{};
};

/// One recording or sequence.
struct Evaluation {
  std::string name;
  std::vector<FrameFigures> frames;               ///< those compared and scored
  std::map<std::string, std::uint64_t> left_out;  ///< reason -> frames that were not compared
  /// The compared frame with the most events, for the eye. Empty when there is none.
  std::array<cv::Mat, kMethodCount> example;
  std::int64_t example_stamp_ns = 0;

  /// Mean over all frames that have the measure.
  std::optional<double> mean(Method method, Measure measure) const;
  double medianRuntimeMs(Method method) const;
  double maxRuntimeMs(Method method) const;
  double meanSearchedContrast() const;  ///< [natural log]
};

/// Mean of the evaluations' means, each counting the same.
std::optional<double> meanOver(const std::vector<const Evaluation*>& evaluations, Method method,
                               Measure measure);

/// Collects compared frames and scores them.
class EvaluationRecorder {
 public:
  /// The true frame at an instant, or an empty image.
  using TruthSource = std::function<cv::Mat(std::int64_t stamp_ns)>;

  /// \param scorer must outlive this object
  EvaluationRecorder(std::string name, const FrameScorer& scorer, TruthSource truth);

  void add(const ComparedFrame& frame);
  const Evaluation& evaluation() const { return evaluation_; }

 private:
  const FrameScorer& scorer_;
  TruthSource truth_;
  Evaluation evaluation_;
  std::array<FeatureMemory, kMethodCount> memories_;
  std::uint64_t example_events_ = 0;
  int unscored_ = 0;  ///< of the first frames
};

}  // namespace fast_edi
