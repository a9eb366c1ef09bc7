/// \file
/// `deblur_bag`: a recording in, the same recording with deblurred frames out, or a film of it.

#include <csignal>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <boost/program_options.hpp>

#include "command_line.hpp"
#include "fast_edi/bags/bag_deblurrer.hpp"
#include "fast_edi/bags/bag_error.hpp"
#include "fast_edi/bags/bag_writer.hpp"
#include "fast_edi/bags/message_source.hpp"
#include "fast_edi/bags/open_messages.hpp"
#include "fast_edi/bags/topic_names.hpp"
#include "fast_edi/config/learned_file.hpp"
#include "fast_edi/config/parameters_from_yaml.hpp"
#include "film/film_writer.hpp"
#include "film/frame_folder.hpp"
#include "progress_bar.hpp"

namespace {

namespace po = boost::program_options;
namespace tools = fast_edi::tools;
using tools::kDone;
using tools::kInputIncomplete;
using tools::kInterrupted;

constexpr int kDefaultFilmRate_hz = 500;

/// The signal that asked to stop, 0 before. The only thing that a signal's handler may touch.
volatile std::sig_atomic_t interrupting_signal = 0;

extern "C" void noteSignal(int signal) {
  interrupting_signal = signal;
}

void handleSignals() {
  struct sigaction stop = {};
  stop.sa_handler = noteSignal;
  stop.sa_flags = SA_RESETHAND;  // a second one ends the program at once
  sigaction(SIGINT, &stop, nullptr);
  sigaction(SIGTERM, &stop, nullptr);
  // A file larger than the process may write: an error that can be reported, not the end.
  std::signal(SIGXFSZ, SIG_IGN);
}

struct Arguments {
  std::vector<std::string> inputs;
  std::string output;
  std::string config;
  std::string compression;
  fast_edi::TopicNames topics;
  std::vector<std::string> overrides;
  bool overwrite = false;
  std::string video;
  std::string frames;
  std::string trust;
  std::string learned;
  std::string save_learned;
  int film_rate_hz = kDefaultFilmRate_hz;
};

po::options_description describeOptions(Arguments& arguments) {
  fast_edi::TopicNames& topics = arguments.topics;
  po::options_description options("Options");
  options.add_options()("help,h", "print this")(
      "in", po::value(&arguments.inputs)->required()->multitoken()->value_name("BAG..."),
      "recording to read, or several of one camera in the order of their record times")(
      "out", po::value(&arguments.output)->value_name("BAG"),
      "recording to write; needed unless --video or --frames is given")(
      "frames", po::value(&arguments.frames)->value_name("FOLDER"),
      "folder for the deblurred frames as PNG, and frames.csv with their stamps and exposures")(
      "trust", po::value(&arguments.trust)->value_name("FOLDER"),
      "the same for how far filter_reblur trusted each pixel: black not at all, white fully")(
      "video", po::value(&arguments.video)->value_name("FILM"),
      "film to write, in slow motion: .mp4, .mov (MPEG-4) or .avi (Motion JPEG)")(
      "fps",
      po::value(&arguments.film_rate_hz)->default_value(arguments.film_rate_hz)->value_name("RATE"),
      "images of the film for each second of recording; it plays 30 of them a second")(
      "config", po::value(&arguments.config)->value_name("YAML"),
      "parameters, e.g. cfg/davis346.yaml; not needed when both contrast thresholds are given as "
      "name:=value");
  options.add_options()("save-learned", po::value(&arguments.save_learned)->value_name("YAML"),
                        "file for the contrast thresholds and the event delay in force at the end")(
      "learned", po::value(&arguments.learned)->value_name("YAML"),
      "such a file of an earlier recording: start from these values instead of those of --config");
  tools::addTopicOptions(options, topics);
  options.add_options()("camera-info", po::value(&topics.camera_info)->value_name("TOPIC"),
                        "calibration; the sibling of --image by default, may be missing")(
      "output", po::value(&topics.output)->value_name("NAMESPACE"),
      "namespace of the deblurred topics; by default `deblurred` beside --image")(
      "compression", po::value(&arguments.compression)->default_value("same")->value_name("KIND"),
      "of the output: none, bz2, lz4, or the same as the input's");
  tools::addForceOption(options, arguments.overwrite);
  return options;
}

tools::HelpText helpText() {
  return {
      "Usage: deblur_bag --in IN.bag --out OUT.bag --config cfg/davis346.yaml "
      "[options] [parameter:=value ...]\n"
      "       deblur_bag --in IN.bag --video OUT.mp4 --fps 500 --config ...\n"
      "       deblur_bag --in IN.bag --frames FOLDER --config ...\n\n"
      "Copies a recording and adds its deblurred frames as <image "
      "namespace>/deblurred/image_raw and\n.../camera_info. Parameters given as name:=value "
      "come before those of the YAML file.\n"
      "A film shows latent images at a fixed rate, between exposures too where events bridge\n"
      "the gap; where they do not, the nearest image is held.\n\n"
      "The output grows as OUT.bag.active and gets its name when it is complete. What a full "
      "disk or\nkill -9 leaves of it can be opened after `rosbag reindex`.\n",
      "0 done; 1 failed, no output; 2 the input was cut short or damaged: all "
      "of it that\ncould be read is in the output, which is complete and indexed; 130, 143 "
      "interrupted by Ctrl-C\nor SIGTERM: the output is complete and indexed up to there."};
}

/// \return false when help was asked for and given
bool parseArguments(int argc, char** argv, Arguments& arguments) {
  const po::options_description visible = describeOptions(arguments);
  auto values = tools::readCommandLine(argc, argv, visible, helpText(), &arguments.overrides);
  if (!values) {
    return false;
  }
  po::notify(*values);
  // --in takes every word up to the next option.
  const std::vector<std::string> words = std::exchange(arguments.inputs, {});
  tools::requireRecordings(words, arguments.inputs, arguments.overrides);
  const std::string& kind = arguments.compression;
  if (kind != "same" && !fast_edi::isKnownCompression(kind)) {
    throw po::error("--compression " + kind + ": expected same, none, bz2 or lz4");
  }
  if (arguments.output.empty() && arguments.video.empty() && arguments.frames.empty() &&
      arguments.trust.empty()) {
    throw po::error("neither --out nor --video nor --frames is given: nothing to write");
  }
  if (arguments.film_rate_hz < 1 || arguments.film_rate_hz > fast_edi::kMaxLatentRate_hz) {
    throw po::error("--fps " + std::to_string(arguments.film_rate_hz) + ": expected 1.." +
                    std::to_string(fast_edi::kMaxLatentRate_hz));
  }
  return true;
}

void printInterruption(const fast_edi::MessageSource& reader,
                       const fast_edi::BagDeblurReport& report) {
  if (report.interrupted) {
    // Other recordings than bags do not tell how many messages they make.
    const std::string of_all =
        reader.countsMessages() ? " of " + std::to_string(reader.length()) : std::string();
    std::cerr << "interrupted by " << (interrupting_signal == SIGINT ? "SIGINT" : "SIGTERM")
              << " after " << report.messages << of_all
              << " messages: the output is closed and ends there\n";
  }
}

void printDamage(const fast_edi::MessageSource& reader, const fast_edi::BagDeblurReport& report,
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
void printMissing(const fast_edi::BagDeblurReport& report, const Arguments& arguments) {
  const std::string name = fast_edi::nameOf(arguments.inputs);
  if (report.counters.frames_in == 0) {
    std::cerr << "warning: " << name << " has no frames on " << arguments.topics.image
              << ": nothing was deblurred\n";
  }
  if (report.counters.events_in == 0) {
    std::cerr << "warning: " << name << " has no events on " << arguments.topics.events << "\n";
  }
}

void printFilm(const fast_edi::FilmReport& film, const std::string& path) {
  std::cout << "film: " << film.images << " images";
  if (film.held > 0) {
    std::cout << ", " << film.held << " of them held for want of a latent image";
  }
  if (film.cuts > 0) {
    std::cout << ", " << film.cuts << " cuts where time jumps";
  }
  if (film.left_out > 0) {
    std::cout << ", " << film.left_out << " images of another size or encoding left out";
  }
  std::cout << "\nwritten: " << path << "\n";
}

/// A deblurred frame, or one that was passed through; its exposure where that is known.
void addTo(fast_edi::FrameFolder& folder, const sensor_msgs::Image& image,
           const fast_edi::OutputFrame& frame) {
  const fast_edi::ExposureInterval& exposure = frame.exposure;
  folder.add(image, exposure.length() > 0 ? std::optional(exposure) : std::nullopt);
}

/// Those of --learned first, which the command line's then replace.
std::vector<std::string> overridesOf(const Arguments& arguments) {
  std::vector<std::string> overrides;
  if (!arguments.learned.empty()) {
    overrides = fast_edi::learnedOverrides(arguments.learned);
  }
  overrides.insert(overrides.end(), arguments.overrides.begin(), arguments.overrides.end());
  return overrides;
}

int run(const Arguments& arguments) {
  const std::unique_ptr<fast_edi::MessageSource> recording =
      fast_edi::openMessages(arguments.inputs);
  fast_edi::MessageSource& reader = *recording;
  fast_edi::LoadedParameters parameters =
      tools::loadParametersFor(reader, arguments.config, overridesOf(arguments));
  if (!arguments.video.empty()) {
    parameters.deblur.latent.rate_hz = arguments.film_rate_hz;
  }
  tools::printWarnings(parameters);
  const std::string faults = fast_edi::checkTopics(arguments.topics, reader.connections());
  if (!faults.empty()) {
    throw fast_edi::BagError(fast_edi::nameOf(arguments.inputs) + ": " + faults);
  }
  const std::string compression =
      arguments.compression == "same" ? reader.compression() : arguments.compression;
  std::optional<fast_edi::FilmWriter> film;
  if (!arguments.video.empty()) {
    film.emplace(arguments.video, arguments.film_rate_hz, arguments.overwrite);
  }
  std::optional<fast_edi::FrameFolder> folder;
  if (!arguments.frames.empty()) {
    folder.emplace(arguments.frames, arguments.overwrite);
  }
  std::optional<fast_edi::FrameFolder> trust;
  if (!arguments.trust.empty()) {
    if (!parameters.deblur.filter.reblur) {
      throw po::error("--trust needs filter_reblur:=true");
    }
    trust.emplace(arguments.trust, arguments.overwrite);
  }
  std::optional<fast_edi::LearnedFile> learned;
  if (!arguments.save_learned.empty()) {
    tools::requireFree(arguments.save_learned, arguments.overwrite);
    learned.emplace(arguments.save_learned);
  }
  std::optional<fast_edi::BagWriter> writer;
  if (!arguments.output.empty()) {
    writer.emplace(arguments.output, arguments.inputs, compression, arguments.overwrite);
  }
  fast_edi::BagDeblurReport report;
  {
    fast_edi::ProgressBar bar("deblurring");
    fast_edi::BagDeblurrer deblurrer(
        reader, writer ? &*writer : nullptr, arguments.topics, parameters,
        [&bar](std::uint64_t done, std::uint64_t total) { bar.update(done, total); });
    if (trust) {
      deblurrer.showTrust();
    }
    deblurrer.setOutputHandler([&](const fast_edi::BagPipeline::Output& output) {
      if (folder) {
        addTo(*folder, *output.image, output.frame);
      }
      if (trust) {
        addTo(*trust, *output.trust, output.frame);
      }
      if (film) {
        film->addFrame(*output.image);
        for (const sensor_msgs::ImagePtr& latent : output.latent) {
          film->addLatent(*latent);
        }
      }
    });
    deblurrer.setStopRequest([] { return interrupting_signal != 0; });
    report = deblurrer.run();
  }
  if (writer) {
    writer->close();
  }
  if (learned) {
    learned->write(report.thresholds, report.event_delay_ns);
  }
  if (film) {
    film->close();
  }
  if (folder) {
    folder->close();
  }
  if (trust) {
    trust->close();
  }
  printSummary(std::cout, report);
  if (writer) {
    std::cout << "written: " << arguments.output << "\n";
  }
  if (learned) {
    std::cout << "written: " << arguments.save_learned << "\n";
  }
  if (film) {
    printFilm(film->report(), arguments.video);
  }
  if (folder) {
    std::cout << "written: " << folder->frames() << " frames to " << arguments.frames << "\n";
  }
  if (trust) {
    std::cout << "written: " << trust->frames() << " maps of trust to " << arguments.trust << "\n";
  }
  std::cout << std::flush;
  if (!report.interrupted) {
    printMissing(report, arguments);
  }
  printDamage(reader, report, fast_edi::nameOf(arguments.inputs));
  tools::printMalformed(report.malformed_messages);
  if (folder && folder->leftOut() > 0) {
    std::cerr << "warning: " << folder->leftOut() << " frames that PNG cannot hold left out of "
              << arguments.frames << "\n";
  }
  printInterruption(reader, report);
  if (report.interrupted) {
    return kInterrupted + interrupting_signal;
  }
  return report.incomplete() || (folder && folder->leftOut() > 0) ? kInputIncomplete : kDone;
}

}  // namespace

int main(int argc, char** argv) {
  handleSignals();
  return tools::runTool("deblur_bag", [argc, argv] {
    Arguments arguments;
    return parseArguments(argc, argv, arguments) ? run(arguments) : kDone;
  });
}
