#include "evaluation/evaluation.hpp"

#include <algorithm>
#include <utility>

namespace fast_edi {
namespace {

std::vector<double> runtimes(const Evaluation& evaluation, std::size_t column) {
  std::vector<double> values;
  for (const FrameFigures& frame : evaluation.frames) {
    if (frame.runtime_ms[column] > 0.0) {
      values.push_back(frame.runtime_ms[column]);
    }
  }
  std::sort(values.begin(), values.end());
  return values;
}

}  // namespace

std::optional<double> Evaluation::mean(std::size_t column, Measure measure) const {
  double sum = 0.0;
  int count = 0;
  for (const FrameFigures& frame : frames) {
    const std::optional<double>& value = frame.scores[column][indexOf(measure)];
    if (value) {
      sum += *value;
      ++count;
    }
  }
  return count > 0 ? std::optional<double>(sum / count) : std::nullopt;
}

double Evaluation::medianRuntimeMs(std::size_t column) const {
  const std::vector<double> values = runtimes(*this, column);
  return values.empty() ? 0.0 : values[values.size() / 2];
}

double Evaluation::maxRuntimeMs(std::size_t column) const {
  const std::vector<double> values = runtimes(*this, column);
  return values.empty() ? 0.0 : values.back();
}

double Evaluation::meanSearchedContrast() const {
  double sum = 0.0;
  for (const FrameFigures& frame : frames) {
    sum += frame.searched_contrast;
  }
  return frames.empty() ? 0.0 : sum / static_cast<double>(frames.size());
}

std::optional<double> meanOver(const std::vector<const Evaluation*>& evaluations,
                               std::size_t column, Measure measure) {
  double sum = 0.0;
  int count = 0;
  for (const Evaluation* evaluation : evaluations) {
    if (const std::optional<double> value = evaluation->mean(column, measure)) {
      sum += *value;
      ++count;
    }
  }
  return count > 0 ? std::optional<double>(sum / count) : std::nullopt;
}

EvaluationRecorder::EvaluationRecorder(std::string name, const FrameScorer& scorer,
                                       TruthSource truth, const OtherMethods& others)
    : scorer_(scorer), truth_(std::move(truth)), memories_(kMethodCount + others.size()) {
  evaluation_.name = std::move(name);
  for (const std::unique_ptr<OtherMethod>& other : others) {
    others_.push_back(other.get());
    evaluation_.others.push_back(other->name());
  }
}

void EvaluationRecorder::forgetFeatures() {
  for (FeatureMemory& memory : memories_) {
    memory.clear();
  }
}

void EvaluationRecorder::add(const ComparedFrame& frame) {
  const bool chosen = scorer_.options().scored.contains(++frames_);
  if (!frame.compared) {
    if (chosen) {
      ++evaluation_.left_out[toString(frame.pass_reason)];
    }
    forgetFeatures();
    return;
  }
  if (unscored_ < scorer_.options().first_frames_unscored) {
    ++unscored_;
    return;
  }
  if (!chosen) {
    forgetFeatures();
    return;
  }
  std::vector<cv::Mat> images(frame.images.begin(), frame.images.end());
  const cv::Mat truth = truth_(frame.stamp_ns);
  images[indexOf(Method::kTruth)] = truth;
  const TrueFrame true_frame = scorer_.trueFrame(truth);

  FrameFigures figures;
  figures.stamp_ns = frame.stamp_ns;
  figures.exposure_ns = frame.exposure.length();
  figures.events = frame.events;
  figures.searched_contrast = frame.searched_contrast;
  figures.runtime_ms.assign(frame.runtime_ms.begin(), frame.runtime_ms.end());
  for (OtherMethod* other : others_) {
    const OtherMethod::Result result =
        other->deblur({frame.stamp_ns, frame.input_stamp_ns, images[indexOf(Method::kBlurry)]});
    images.push_back(result.image);
    figures.runtime_ms.push_back(result.runtime_ms);
  }
  figures.scores.resize(images.size());
  for (std::size_t column = 0; column < images.size(); ++column) {
    if (images[column].empty()) {
      memories_[column].clear();
      continue;
    }
    // Comparing the truth with itself says nothing.
    const bool is_truth = column == indexOf(Method::kTruth);
    figures.scores[column] =
        scorer_.score(images[column], is_truth ? TrueFrame() : true_frame, memories_[column]);
  }
  if (evaluation_.frames.empty() || frame.events > example_events_) {
    example_events_ = frame.events;
    evaluation_.example = images;
    evaluation_.example_stamp_ns = frame.stamp_ns;
  }
  evaluation_.frames.push_back(std::move(figures));
}

}  // namespace fast_edi
