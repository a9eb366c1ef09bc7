#include "evaluation/evaluation.hpp"

#include <algorithm>
#include <utility>

namespace fast_edi {
namespace {

std::vector<double> runtimes(const Evaluation& evaluation, Method method) {
  std::vector<double> values;
  for (const FrameFigures& frame : evaluation.frames) {
    values.push_back(frame.runtime_ms[indexOf(method)]);
  }
  std::sort(values.begin(), values.end());
  return values;
}

}  // namespace

std::optional<double> Evaluation::mean(Method method, Measure measure) const {
  double sum = 0.0;
  int count = 0;
  for (const FrameFigures& frame : frames) {
    const std::optional<double>& value = frame.scores[indexOf(method)][indexOf(measure)];
    if (value) {
      sum += *value;
      ++count;
    }
  }
  return count > 0 ? std::optional<double>(sum / count) : std::nullopt;
}

double Evaluation::medianRuntimeMs(Method method) const {
  const std::vector<double> values = runtimes(*this, method);
  return values.empty() ? 0.0 : values[values.size() / 2];
}

double Evaluation::maxRuntimeMs(Method method) const {
  const std::vector<double> values = runtimes(*this, method);
  return values.empty() ? 0.0 : values.back();
}

double Evaluation::meanSearchedContrast() const {
  double sum = 0.0;
  for (const FrameFigures& frame : frames) {
    sum += frame.searched_contrast;
  }
  return frames.empty() ? 0.0 : sum / static_cast<double>(frames.size());
}

std::optional<double> meanOver(const std::vector<const Evaluation*>& evaluations, Method method,
                               Measure measure) {
  double sum = 0.0;
  int count = 0;
  for (const Evaluation* evaluation : evaluations) {
    if (const std::optional<double> value = evaluation->mean(method, measure)) {
      sum += *value;
      ++count;
    }
  }
  return count > 0 ? std::optional<double>(sum / count) : std::nullopt;
}

EvaluationRecorder::EvaluationRecorder(std::string name, const FrameScorer& scorer,
                                       TruthSource truth)
    : scorer_(scorer), truth_(std::move(truth)) {
  evaluation_.name = std::move(name);
}

void EvaluationRecorder::add(const ComparedFrame& frame) {
  if (!frame.compared) {
    ++evaluation_.left_out[toString(frame.pass_reason)];
    for (FeatureMemory& memory : memories_) {
      memory.clear();
    }
    return;
  }
  if (unscored_ < scorer_.options().first_frames_unscored) {
    ++unscored_;
    return;
  }
  std::array<cv::Mat, kMethodCount> images = frame.images;
  const cv::Mat truth = truth_(frame.stamp_ns);
  images[indexOf(Method::kTruth)] = truth;
  const TrueFrame true_frame = scorer_.trueFrame(truth);

  FrameFigures figures;
  figures.stamp_ns = frame.stamp_ns;
  figures.exposure_ns = frame.exposure.length();
  figures.events = frame.events;
  figures.searched_contrast = frame.searched_contrast;
  figures.runtime_ms = frame.runtime_ms;
  for (std::size_t method = 0; method < kMethodCount; ++method) {
    if (images[method].empty()) {
      memories_[method].clear();
      continue;
    }
    // Comparing the truth with itself says nothing.
    const bool is_truth = method == indexOf(Method::kTruth);
    figures.scores[method] =
        scorer_.score(images[method], is_truth ? TrueFrame() : true_frame, memories_[method]);
  }
  if (evaluation_.frames.empty() || frame.events > example_events_) {
    example_events_ = frame.events;
    evaluation_.example = images;
    evaluation_.example_stamp_ns = frame.stamp_ns;
  }
  evaluation_.frames.push_back(figures);
}

}  // namespace fast_edi
