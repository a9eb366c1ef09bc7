/// \file
/// The figures of an evaluation: frames x methods x measures, and what is told of them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "evaluation/method_comparison.hpp"
#include "evaluation/other_method.hpp"
#include "fast_edi/base/types.hpp"
#include "measures/frame_scorer.hpp"

namespace fast_edi {

/// Columns are the methods by indexOf(), then the other methods in their order.
struct FrameFigures {
  std::int64_t stamp_ns = 0;
  std::int64_t exposure_ns = 0;
  std::uint64_t events = 0;
  double searched_contrast = 0.0;                                      ///< [natural log]
  std::vector<Scores> scores = std::vector<Scores>(kMethodCount);      ///< by column
  std::vector<double> runtime_ms = std::vector<double>(kMethodCount);  ///< by column; 0: not known
};

/// One recording or sequence.
struct Evaluation {
  std::string name;
  std::vector<std::string> others;                ///< names of the columns from kMethodCount on
  std::vector<FrameFigures> frames;               ///< those compared and scored
  std::map<std::string, std::uint64_t> left_out;  ///< reason -> frames that were not compared
  /// The compared frame with the most events, for the eye, by column. Empty when there is none.
  std::vector<cv::Mat> example = std::vector<cv::Mat>(kMethodCount);
  std::int64_t example_stamp_ns = 0;

  /// Mean over all frames that have the measure.
  std::optional<double> mean(std::size_t column, Measure measure) const;
  std::optional<double> mean(Method method, Measure measure) const {
    return mean(indexOf(method), measure);
  }
  /// Of the frames whose run time is known; 0 for none.
  double medianRuntimeMs(std::size_t column) const;
  double maxRuntimeMs(std::size_t column) const;
  double meanSearchedContrast() const;  ///< [natural log]
};

/// Mean of the evaluations' means, each counting the same.
std::optional<double> meanOver(const std::vector<const Evaluation*>& evaluations,
                               std::size_t column, Measure measure);

/// Collects compared frames and scores them.
class EvaluationRecorder {
 public:
  /// The true frame at an instant, or an empty image.
  using TruthSource = std::function<cv::Mat(std::int64_t stamp_ns)>;

  /// \param scorer must outlive this object, as must \p others
  EvaluationRecorder(std::string name, const FrameScorer& scorer, TruthSource truth,
                     const OtherMethods& others = {});

  /// \throws what the other methods throw
  void add(const ComparedFrame& frame);
  const Evaluation& evaluation() const { return evaluation_; }

 private:
  /// Of all columns: the next frame does not follow the last one.
  void forgetFeatures();

  const FrameScorer& scorer_;
  TruthSource truth_;
  std::vector<OtherMethod*> others_;
  Evaluation evaluation_;
  std::vector<FeatureMemory> memories_;  ///< by column
  std::uint64_t example_events_ = 0;
  int frames_ = 0;    ///< added so far
  int unscored_ = 0;  ///< of the first frames
};

}  // namespace fast_edi
