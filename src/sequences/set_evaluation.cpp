#include "sequences/set_evaluation.hpp"

#include <algorithm>
#include <map>
#include <memory>
#include <stdexcept>

#include "evaluation/method_comparison.hpp"
#include "evaluation/pipeline.hpp"
#include "sequences/sequence_input.hpp"
#include "simulation/davis_simulator.hpp"

namespace fast_edi {
namespace {

/// Plain EDI and the variants over one sequence.
class VariantRun {
 public:
  VariantRun(const SetSequence& sequence, const std::vector<Variant>& variants,
             const FrameScorer& scorer, SetResult& result)
      : scorer_(scorer), result_(result) {
    const auto known = [&](const DeblurParameters& parameters) {
      return sensorParameters(parameters, sequence.sequence.settings, sequence.threshold_factor);
    };
    const DeblurParameters first =
        variants.empty() ? DeblurParameters() : variants.front().parameters;
    addPipeline(parametersOf(Method::kPlain, known(first)));
    for (const Variant& variant : variants) {
      addPipeline(parametersOf(Method::kOurs, known(variant.parameters)));
    }
    const std::size_t columns = columnNames(variants).size();
    result_.scores.resize(columns);
    result_.runtime_ms.resize(columns);
    memories_.resize(columns);
  }

  template <typename Call>
  void run(Call call) {
    for (const auto& pipeline : pipelines_) pipeline->run(call);
  }

  void expectFrame(const SimulatedFrame& frame) {
    truths_[frame.exposure.at(ExposureInstant::kMid)] = frame.sharp;
  }

  /// Scores the frames that all pipelines have finished. \return how many
  int score() {
    int scored = 0;
    while (std::all_of(pipelines_.begin(), pipelines_.end(),
                       [](const auto& pipeline) { return pipeline->hasFinished(); })) {
      std::vector<Pipeline::Finished> finished;
      for (const auto& pipeline : pipelines_) finished.push_back(pipeline->take());
      scoreFrame(finished);
      ++scored;
    }
    return scored;
  }

 private:
  void addPipeline(const DeblurParameters& parameters) {
    pipelines_.push_back(std::make_unique<Pipeline>(parameters));
  }

  void scoreFrame(const std::vector<Pipeline::Finished>& finished) {
    const OutputFrame& output = finished.front().output;
    for (const Pipeline::Finished& other : finished) {
      if (other.output.stamp_ns != output.stamp_ns) {
        throw std::logic_error("variants disagree about the next output frame");
      }
    }
    if (!output.deblurred) {
      ++result_.left_out;
      for (FeatureMemory& memory : memories_) memory.clear();
      return;
    }
    if (++frames_ <= scorer_.options().first_frames_unscored) return;
    const TrueFrame truth = scorer_.trueFrame(truths_.at(output.stamp_ns));
    addScores(kBlurryColumn, *std::static_pointer_cast<const cv::Mat>(output.input.owner), truth,
              0.0);
    for (std::size_t i = 0; i < finished.size(); ++i) {
      addScores(kPlainColumn + i, finished[i].image, truth, finished[i].runtime_ms);
    }
    // Comparing the truth with itself says nothing.
    const std::size_t truth_column = memories_.size() - 1;
    result_.scores[truth_column].push_back(scorer_.score(truth.image, {}, memories_[truth_column]));
    result_.runtime_ms[truth_column].push_back(0.0);
  }

  void addScores(std::size_t column, const cv::Mat& image, const TrueFrame& truth,
                 double runtime_ms) {
    result_.scores[column].push_back(scorer_.score(image, truth, memories_[column]));
    result_.runtime_ms[column].push_back(runtime_ms);
  }

  const FrameScorer& scorer_;
  SetResult& result_;
  std::vector<std::unique_ptr<Pipeline>> pipelines_;
  std::vector<FeatureMemory> memories_;
  std::map<std::int64_t, cv::Mat> truths_;
  int frames_ = 0;
};

}  // namespace

std::optional<double> SetResult::mean(std::size_t column, Measure measure) const {
  double sum = 0.0;
  int count = 0;
  for (const Scores& frame : scores.at(column)) {
    if (const std::optional<double>& value = frame[indexOf(measure)]) {
      sum += *value;
      ++count;
    }
  }
  return count > 0 ? std::optional<double>(sum / count) : std::nullopt;
}

std::vector<std::string> columnNames(const std::vector<Variant>& variants) {
  std::vector<std::string> names = {"blurry", "plain EDI"};
  for (const Variant& variant : variants) names.push_back(variant.name);
  names.emplace_back("true frames");
  return names;
}

SetResult evaluateVariants(const SetSequence& sequence, const std::vector<Variant>& variants,
                           const FrameScorer& scorer, const std::function<void(int)>& progress) {
  const SimulationSettings& settings = sequence.sequence.settings;
  SetResult result;
  result.name = sequence.sequence.name;
  result.factors = sequence.factors;
  VariantRun run(sequence, variants, scorer, result);
  DavisSimulator simulator(settings);
  WireArrays arrays;
  SimulatedInterval interval;
  int done = 0;
  while (simulator.next(interval)) {
    run.expectFrame(interval.frame);
    // A frame leaves the camera when its exposure ends, before the last events that cover it.
    const InputFrame frame =
        inputFrame(interval.frame.exposure.at(ExposureInstant::kMid), interval.frame.blurry);
    const std::int64_t end_ns = interval.frame.exposure.end_ns;
    run.run([&](Deblurrer& deblurrer) { deblurrer.addFrame(frame, end_ns); });
    const WireArrays::Array array = arrays.pack(interval.events);
    run.run([&](Deblurrer& deblurrer) {
      deblurrer.addEvents(array.events, settings.sensor.size, array.sequence, interval.end_ns);
    });
    done += run.score();
    progress(done);
  }
  run.run([](Deblurrer& deblurrer) { deblurrer.finish(); });
  progress(done + run.score());
  return result;
}

}  // namespace fast_edi
