#include "tools/evaluate/evaluate_video.hpp"

#include <cstdint>
#include <iostream>
#include <vector>

#include "command_line.hpp"
#include "progress_bar.hpp"
#include "sequences/sequences.hpp"
#include "sequences/video_quality.hpp"

namespace fast_edi::evaluate {

int evaluateVideo(const Arguments& arguments, const DeblurParameters& parameters) {
  std::vector<VideoQuality> qualities;
  const int frames = framesOfTwelve(arguments);
  const auto sequences = evaluationSequences(frames, arguments.seeds);
  const std::uint64_t total = sequences.size() * static_cast<std::uint64_t>(frames);
  {
    ProgressBar bar("evaluating");
    for (const EvaluationSequence& sequence : sequences) {
      const std::uint64_t done_before = qualities.size() * static_cast<std::uint64_t>(frames);
      qualities.push_back(videoQuality(
          sequence, parameters, arguments.video_images, arguments.scorer.first_frames_unscored,
          [&](int done) { bar.update(done_before + static_cast<std::uint64_t>(done), total); }));
    }
  }
  printVideoTable(std::cout, qualities);
  return tools::kDone;
}

}  // namespace fast_edi::evaluate
