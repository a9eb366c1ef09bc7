/// \file
/// `evaluate`: blurry input, plain EDI, the paper's counter EDI, EDI with searched contrast and
/// this package's own output, measured on a recording or on the fixed set of simulated sequences.

#include <opencv2/core/utility.hpp>

#include "command_line.hpp"
#include "fast_edi/config/parameters_from_yaml.hpp"
#include "sequences/sequence_sets.hpp"
#include "tools/evaluate/evaluate_arguments.hpp"
#include "tools/evaluate/evaluate_recording.hpp"
#include "tools/evaluate/evaluate_set.hpp"
#include "tools/evaluate/evaluate_twelve.hpp"
#include "tools/evaluate/evaluate_video.hpp"

namespace fast_edi::evaluate {
namespace {

int run(const Arguments& arguments) {
  // Run times are those of one thread; results do not depend on how many cores there are.
  cv::setNumThreads(1);
  if (arguments.sequences.empty() && arguments.video_images == 0) {
    return evaluateRecording(arguments);
  }
  const LoadedParameters parameters = loadParameters(arguments);
  tools::printWarnings(parameters);
  if (arguments.video_images != 0) {
    return evaluateVideo(arguments, parameters.deblur);
  }
  const SequenceSet set = sequenceSetFromName(arguments.sequences);
  return set == SequenceSet::kTwelve ? evaluateTwelve(arguments, parameters.deblur)
                                     : evaluateSet(arguments, set, parameters.deblur);
}

}  // namespace
}  // namespace fast_edi::evaluate

int main(int argc, char** argv) {
  return fast_edi::tools::runTool("evaluate", [argc, argv] {
    fast_edi::evaluate::Arguments arguments;
    return fast_edi::evaluate::parseArguments(argc, argv, arguments)
               ? fast_edi::evaluate::run(arguments)
               : fast_edi::tools::kDone;
  });
}
