#include "tools/evaluate/evaluate_twelve.hpp"

#include <cstdint>
#include <iostream>
#include <list>
#include <string>
#include <vector>

#include "command_line.hpp"
#include "evaluation/evaluation.hpp"
#include "evaluation/report.hpp"
#include "progress_bar.hpp"
#include "sequences/sequences.hpp"
#include "tools/evaluate/evaluate_methods.hpp"
#include "tools/evaluate/evaluate_text.hpp"

namespace fast_edi::evaluate {

int evaluateTwelve(const Arguments& arguments, const DeblurParameters& parameters) {
  const int frames = framesOfTwelve(arguments);
  std::vector<std::string> incomplete;  // nothing, without --column
  const OtherMethods others = otherMethods(arguments, incomplete);
  prepareReportFolder(arguments.output, arguments.overwrite);
  const std::vector<EvaluationSequence> sequences = evaluationSequences(frames, arguments.seeds);
  const FrameScorer scorer(arguments.scorer);
  std::list<Evaluation> evaluations;
  std::vector<EvaluationGroup> groups = {{"sequences for tuning", {}},
                                         {"sequences not tuned on", {}}};
  {
    ProgressBar bar("evaluating");
    const std::uint64_t total = sequences.size() * static_cast<std::uint64_t>(frames);
    std::uint64_t done_before = 0;
    for (const EvaluationSequence& sequence : sequences) {
      evaluations.push_back(evaluateSequence(
          sequence, parameters, arguments.threshold_factor, arguments.search, scorer, others,
          [&](int done) { bar.update(done_before + static_cast<std::uint64_t>(done), total); }));
      groups[sequence.for_tuning ? 0 : 1].members.push_back(&evaluations.back());
      done_before += static_cast<std::uint64_t>(frames);
    }
  }
  std::vector<std::string> notes = notesOf(scorer);
  for (const Evaluation& evaluation : evaluations) {
    for (const auto& [reason, count] : evaluation.left_out) {
      notes.push_back(evaluation.name + ": " + std::to_string(count) +
                      " frames left out: " + reason);
    }
  }
  if (arguments.threshold_factor != 1.0) {
    notes.push_back("All methods got the true mean thresholds times " +
                    decimal(arguments.threshold_factor));
  }
  printGroups(groups, notes);
  std::cout << "written: "
            << writeReport(arguments.output,
                           {"Evaluation on simulated sequences", arguments.command, notes}, groups)
            << "\n";
  return tools::kDone;
}

}  // namespace fast_edi::evaluate
