/// deblur_bag on damaged bags: the input is the file. Reading, the pipeline, and writing, as the
/// tool does it.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <string>
#include <vector>

#include <ros/console.h>

#include "fast_edi/bags/bag_deblurrer.hpp"
#include "fast_edi/bags/bag_error.hpp"
#include "fast_edi/bags/bag_reader.hpp"
#include "fast_edi/bags/bag_writer.hpp"
#include "fast_edi/bags/topic_names.hpp"
#include "fuzz/fuzzing.hpp"
#include "fuzz/memory_file.hpp"
#include "support/temporary_directory.hpp"

namespace {

using fast_edi::fuzzing::MemoryFile;
using fast_edi::fuzzing::require;

/// rosbag takes longer to open a bag for writing than everything else here takes: one input in so
/// many, by its size, is written as well.
constexpr std::size_t kInputsPerOutput = 8;

const MemoryFile& inputFile() {
  static const MemoryFile file;
  return file;
}

std::string outputPath() {
  static const fast_edi::TemporaryDirectory directory;
  return directory.file("out.bag");
}

fast_edi::LoadedParameters parameters() {
  fast_edi::LoadedParameters parameters;
  parameters.deblur.thresholds = {0.3, 0.2};
  parameters.deblur.exposure_time_ns = 10 * fast_edi::kNanosecondsPerMillisecond;
  parameters.deblur.latent.per_exposure = 1;
  parameters.deblur.max_buffered_events = 10'000;
  return parameters;
}

/// \param writes an output, too
void deblur(const std::string& input, bool writes) {
  fast_edi::BagReader reader(input);
  const fast_edi::TopicNames topics = fast_edi::guessTopics({}, reader.connections());
  static_cast<void>(fast_edi::checkTopics(topics, reader.connections()));
  static_cast<void>(reader.duration());
  std::optional<fast_edi::BagWriter> writer;
  if (writes) {
    writer.emplace(outputPath(), std::vector<std::string>{input}, reader.compression(), true);
    writer->copyChunksOf(*reader.chunks());
  }
  fast_edi::BagDeblurrer deblurrer(reader, writer ? &*writer : nullptr, topics, parameters(),
                                   [](std::uint64_t, std::uint64_t) {});
  const fast_edi::BagDeblurReport report = deblurrer.run();
  require(report.outputs == report.counters.frames_deblurred + report.counters.framesPassed(),
          "each frame put out is written");
  require(report.messages <= reader.messageCount(), "no message is read twice");
  if (!writer) {
    return;
  }
  writer->close();

  // What was written is a whole bag with all messages.
  fast_edi::BagReader written(outputPath());
  require(written.damage().empty(), "the output has no damage");
  require(written.messageCount() >= report.messages + 2 * report.outputs,
          "all messages are in the output");
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  ros::console::shutdown();  // rosbag's complaints about each input
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  inputFile().fill(data, size);
  try {
    deblur(inputFile().path(), size % kInputsPerOutput == 0);
  } catch (const fast_edi::BagError& error) {
    require(*error.what() != '\0', "a refusal says why");
  }
  return 0;
}
