#include "tools/deblur_bag/deblur_bag_arguments.hpp"

#include <algorithm>
#include <string>
#include <thread>
#include <utility>

#include <boost/program_options.hpp>

#include "command_line.hpp"
#include "fast_edi/bags/bag_chunk.hpp"
#include "fast_edi/parameters/parameters.hpp"

namespace fast_edi::deblur_bag {
namespace {

namespace po = boost::program_options;

constexpr int kMostThreads = 64;
/// Integrating is done by one thread at a time, and so is writing: more have little to do.
constexpr int kMostUsefulThreads = 4;

int defaultThreads() {
  const auto cores = static_cast<int>(std::thread::hardware_concurrency());
  return std::clamp(cores, 1, kMostUsefulThreads);
}

po::options_description describeOptions(Arguments& arguments) {
  TopicNames& topics = arguments.topics;
  po::options_description options("Options");
  options.add_options()("help,h", "print this")(
      "in", po::value(&arguments.inputs)->required()->multitoken()->value_name("BAG..."),
      "recording to read, or several parts of one in the order of their record times; with "
      "--out-dir, recordings of their own")("out", po::value(&arguments.output)->value_name("BAG"),
                                            "recording to write; needed unless --out-dir, --video "
                                            "or --frames is given")(
      "out-dir", po::value(&arguments.output_folder)->value_name("FOLDER"),
      "folder for one BAG of each recording, of the same name")(
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
  options.add_options()(
      "save-learned", po::value(&arguments.save_learned)->value_name("YAML"),
      "file for the contrast thresholds and the event delay that were learned; not written if "
      "nothing was")(
      "learned", po::value(&arguments.learned)->value_name("YAML"),
      "such a file of an earlier recording: start from these values instead of those of --config");
  tools::addTopicOptions(options, topics);
  options.add_options()("camera-info", po::value(&topics.camera_info)->value_name("TOPIC"),
                        "calibration; the sibling of --image by default, may be missing")(
      "output", po::value(&topics.output)->value_name("NAMESPACE"),
      "namespace of the deblurred topics; by default `deblurred` beside --image")(
      "compression", po::value(&arguments.compression)->default_value("same")->value_name("KIND"),
      "of the output: none, bz2, lz4, or the same as the input's")(
      "rewrite", po::bool_switch(&arguments.rewrite),
      "write every message anew, in the order of record times; by default, chunks of a bag that "
      "are compressed as the output are copied as they are, which is faster");
  options.add_options()(
      "threads", po::value(&arguments.threads)->default_value(defaultThreads())->value_name("N"),
      "cores to work on at a time; the output is the same for any number");
  tools::addForceOption(options, arguments.overwrite);
  return options;
}

tools::HelpText helpText() {
  return {
      "Usage: deblur_bag --in IN.bag --out OUT.bag --config cfg/davis346.yaml "
      "[options] [parameter:=value ...]\n"
      "       deblur_bag --in *.bag --out-dir FOLDER --config ...\n"
      "       deblur_bag --in IN.bag --video OUT.mp4 --fps 500 --config ...\n"
      "       deblur_bag --in IN.bag --frames FOLDER --config ...\n\n"
      "Copies a recording and adds its deblurred frames as <image "
      "namespace>/deblurred/image_raw and\n.../camera_info. Parameters given as name:=value "
      "come before those of the YAML file.\n"
      "A film shows latent images at a fixed rate, between exposures too where events bridge\n"
      "the gap; where they do not, the nearest image is held.\n\n"
      "The output grows as OUT.bag.active and gets its name when it is complete. What a full "
      "disk or\nkill -9 leaves of it can be opened after `rosbag reindex`. With --out-dir, nothing "
      "is left of an\noutput that did not become complete, and a recording that fails does not "
      "end the run.\n",
      "0 done; 1 failed, no output, with --out-dir of at least one recording; 2 the input was\n"
      "cut short or damaged: all of it that could be read is in the output, which is complete and\n"
      "indexed; 3 done, but no frame was deblurred, with --out-dir of at least one recording: the\n"
      "last line says why; 130, 143 interrupted by Ctrl-C or SIGTERM: the output is complete and\n"
      "indexed up to there (with --out-dir, there is none of this recording and those behind it)."};
}

void requireOutput(const Arguments& arguments) {
  const bool has_single = !arguments.output.empty() || !arguments.video.empty() ||
                          !arguments.frames.empty() || !arguments.trust.empty();
  if (arguments.output_folder.empty()) {
    if (!has_single) {
      throw po::error(
          "neither --out nor --out-dir nor --video nor --frames is given: nothing to write");
    }
  } else if (has_single || !arguments.save_learned.empty()) {
    throw po::error(
        "--out-dir writes a bag of each recording: --out, --video, --frames, --trust and "
        "--save-learned are for one recording alone");
  }
}

}  // namespace

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
  if (kind != "same" && !isKnownCompression(kind)) {
    throw po::error("--compression " + kind + ": expected same, none, bz2 or lz4");
  }
  requireOutput(arguments);
  if (arguments.film_rate_hz < 1 || arguments.film_rate_hz > kMaxLatentRate_hz) {
    throw po::error("--fps " + std::to_string(arguments.film_rate_hz) + ": expected 1.." +
                    std::to_string(kMaxLatentRate_hz));
  }
  if (arguments.threads < 1 || arguments.threads > kMostThreads) {
    throw po::error("--threads " + std::to_string(arguments.threads) + ": expected 1.." +
                    std::to_string(kMostThreads));
  }
  return true;
}

}  // namespace fast_edi::deblur_bag
