#include "tools/deblur_bag/deblur_recording.hpp"

#include <csignal>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <boost/program_options.hpp>

#include "bags/nothing_deblurred.hpp"
#include "command_line.hpp"
#include "fast_edi/bags/bag_error.hpp"
#include "fast_edi/bags/message_source.hpp"
#include "fast_edi/bags/open_messages.hpp"
#include "fast_edi/config/learned_file.hpp"
#include "fast_edi/config/parameters_from_yaml.hpp"
#include "interruption.hpp"
#include "progress_bar.hpp"
#include "tools/deblur_bag/deblur_outputs.hpp"

namespace fast_edi::deblur_bag {
namespace {

void printInterruption(const MessageSource& reader, const BagDeblurReport& report,
                       bool is_one_of_many) {
  if (report.interrupted) {
    // Other recordings than bags do not tell how many messages they make.
    const std::string of_all =
        reader.countsMessages() ? " of " + std::to_string(reader.length()) : std::string();
    std::cerr << "interrupted by " << (tools::interruptingSignal() == SIGINT ? "SIGINT" : "SIGTERM")
              << " after " << report.messages << of_all << " messages: "
              << (is_one_of_many ? "there is no output of this recording"
                                 : "the output is closed and ends there")
              << "\n";
  }
}

void printDamage(const MessageSource& reader, const BagDeblurReport& report,
                 const std::string& input) {
  if (report.damage.empty()) {
    return;
  }
  std::cerr << "warning: " << input << " (" << reader.fileSize()
            << " bytes) is cut short or damaged; its last readable message was recorded at "
            << report.last_record_time << "\n";
  tools::printDamage(input, report.damage);
}

/// What deblurring would need, and the recording does not have.
void printMissing(const BagDeblurReport& report, const Arguments& arguments) {
  const std::string name = nameOf(arguments.inputs);
  if (report.counters.frames_in == 0) {
    std::cerr << "warning: " << name << " has no frames on " << arguments.topics.image
              << ": nothing was deblurred\n";
  }
  if (report.counters.events_in == 0) {
    std::cerr << "warning: " << name << " has no events on " << arguments.topics.events << "\n";
  }
}

/// Those of --learned first, which the command line's then replace.
std::vector<std::string> overridesOf(const Arguments& arguments) {
  std::vector<std::string> overrides;
  if (!arguments.learned.empty()) {
    overrides = learnedOverrides(arguments.learned);
  }
  overrides.insert(overrides.end(), arguments.overrides.begin(), arguments.overrides.end());
  return overrides;
}

LoadedParameters loadParameters(const Arguments& arguments, const MessageSource& reader) {
  LoadedParameters parameters =
      tools::loadParametersFor(reader, arguments.config, overridesOf(arguments));
  if (!arguments.video.empty()) {
    parameters.deblur.latent.rate_hz = arguments.film_rate_hz;
  }
  tools::printWarnings(parameters);
  if (!arguments.trust.empty() && !parameters.deblur.filter.reblur) {
    throw boost::program_options::error("--trust needs filter_reblur:=true");
  }
  return parameters;
}

BagDeblurReport deblur(MessageSource& reader, const Arguments& arguments,
                       const LoadedParameters& parameters, DeblurOutputs& outputs) {
  ProgressBar bar("deblurring");
  BagDeblurrer deblurrer(
      reader, outputs.bag(), arguments.topics, parameters,
      [&bar](std::uint64_t done, std::uint64_t total) { bar.update(done, total); });
  if (outputs.showsTrust()) {
    deblurrer.showTrust();
  }
  deblurrer.setOutputHandler([&](const BagPipeline::Output& output) { outputs.add(output); });
  deblurrer.setThreads(static_cast<std::size_t>(arguments.threads));
  deblurrer.setStopRequest([] { return tools::interruptingSignal() != 0; });
  return deblurrer.run();
}

}  // namespace

RecordingOutcome deblurRecording(const Arguments& given) {
  const std::unique_ptr<MessageSource> reader = openMessages(given.inputs);
  Arguments arguments = given;
  const LoadedParameters parameters = loadParameters(arguments, *reader);
  arguments.topics = tools::topicsIn(*reader, given.topics, nameOf(given.inputs));
  const std::string compression =
      arguments.compression == "same" ? reader->compression() : arguments.compression;
  const bool is_one_of_many = !arguments.output_folder.empty();
  DeblurOutputs outputs(arguments, compression);
  const std::optional<ChunkSource> chunks = reader->chunks();
  if (outputs.bag() != nullptr && chunks && !arguments.rewrite) {
    outputs.bag()->copyChunksOf(*chunks);
  }
  const BagDeblurReport report = deblur(*reader, arguments, parameters, outputs);
  const bool is_written = !(report.interrupted && is_one_of_many);
  if (is_written) {
    outputs.close(report);
    printSummary(std::cout, report);
    outputs.print();
  }
  if (!report.interrupted) {
    printMissing(report, arguments);
  }
  printDamage(*reader, report, nameOf(arguments.inputs));
  tools::printMalformed(report.malformed_messages);
  const bool is_whole = outputs.reportLeftOut() && !report.incomplete();
  printInterruption(*reader, report, is_one_of_many);
  if (report.interrupted) {
    return {report, tools::kInterrupted + tools::interruptingSignal()};
  }
  const std::string nothing = nothingDeblurred(report.counters, report.differing_clocks);
  if (!nothing.empty()) {
    std::cerr << "deblur_bag: " << nothing << "\n";
    return {report, tools::kNothingDeblurred};
  }
  return {report, is_whole ? tools::kDone : tools::kInputIncomplete};
}

}  // namespace fast_edi::deblur_bag
