#include "tools/evaluate/evaluate_set.hpp"

#include <cstdint>
#include <filesystem>
#include <iostream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <boost/program_options.hpp>

#include "command_line.hpp"
#include "evaluation/report.hpp"
#include "progress_bar.hpp"
#include "sequences/set_evaluation.hpp"
#include "sequences/set_report.hpp"
#include "tools/evaluate/evaluate_text.hpp"

namespace fast_edi::evaluate {
namespace {

namespace po = boost::program_options;

/// A variant from its words on the command line: "name key:=value key:=value".
Variant variantFrom(const Arguments& arguments, const std::string& text) {
  std::istringstream stream(text);
  Variant variant;
  stream >> variant.name;
  if (variant.name.empty() || variant.name.find(":=") != std::string::npos) {
    throw po::error("--variant: expected a name and then parameters, got \"" + text + "\"");
  }
  std::vector<std::string> overrides;
  for (std::string word; stream >> word;) {
    overrides.push_back(word);
  }
  variant.parameters = loadParameters(arguments, overrides).deblur;
  return variant;
}

}  // namespace

int evaluateSet(const Arguments& arguments, SequenceSet set, const DeblurParameters& parameters) {
  prepareReportFolder(arguments.output, arguments.overwrite);
  const std::string scores = arguments.output + "/" + arguments.sequences + ".csv";
  if (!arguments.overwrite && std::filesystem::exists(scores)) {
    throw std::runtime_error("cannot write " + scores +
                             ": it exists already (--force replaces it)");
  }
  std::vector<Variant> variants = {{"ours", parameters}};
  for (const std::string& text : arguments.variants) {
    variants.push_back(variantFrom(arguments, text));
  }
  const int frames = arguments.frames > 0 ? arguments.frames : kSetFrames;
  const SequenceSetContents contents = sequencesOf(set, frames, arguments.photographs);
  const FrameScorer scorer(arguments.scorer);
  SetEvaluation evaluation;
  evaluation.columns = columnNames(variants);
  {
    ProgressBar bar("evaluating");
    const std::uint64_t total = contents.sequences.size() * static_cast<std::uint64_t>(frames);
    for (SetSequence sequence : contents.sequences) {
      const std::uint64_t done_before =
          evaluation.results.size() * static_cast<std::uint64_t>(frames);
      sequence.threshold_factor *= arguments.threshold_factor;
      evaluation.results.push_back(evaluateVariants(sequence, variants, scorer, [&](int done) {
        bar.update(done_before + static_cast<std::uint64_t>(done), total);
      }));
    }
  }
  for (const Measure measure : {Measure::kPsnr, Measure::kSsim}) {
    printSetMembers(std::cout, evaluation, measure);
    std::cout << "\n";
  }
  printSetFactors(std::cout, evaluation);
  if (arguments.scorer.extent >= MeasureExtent::kTracks) {
    printSetShares(std::cout, evaluation);
  }
  printSetMeasures(std::cout, evaluation);
  std::cout << "\n";
  printSetRuntimes(std::cout, evaluation);
  for (const std::string& missing : contents.missing) {
    std::cout << "Left out: " << missing << "\n";
  }
  for (const SetResult& result : evaluation.results) {
    if (result.left_out > 0) {
      std::cout << result.name << ": " << result.left_out << " frames passed through\n";
    }
  }
  for (const std::string& note : notesOf(scorer)) {
    std::cout << note << "\n";
  }
  std::filesystem::create_directories(arguments.output);
  writeSetScores(scores, evaluation);
  std::cout << "written: " << scores << "\n";
  return tools::kDone;
}

}  // namespace fast_edi::evaluate
