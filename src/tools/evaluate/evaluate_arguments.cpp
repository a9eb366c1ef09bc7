#include "tools/evaluate/evaluate_arguments.hpp"

#include <filesystem>

#include <yaml-cpp/yaml.h>
#include <boost/program_options.hpp>

#include "command_line.hpp"
#include "tools/evaluate/evaluate_text.hpp"

namespace fast_edi::evaluate {
namespace {

namespace po = boost::program_options;

/// Methods that see the blurry frame alone.
void addOtherMethods(po::options_description& options, Arguments& arguments) {
  po::options_description methods("Other methods, with a recording or --sequences twelve");
  auto add = methods.add_options();
  add("network", po::value(&arguments.networks)->value_name("NAME=MODEL.onnx"),
      "a network of a single image, with 1 or 3 channels in and out; may be repeated");
  add("network-range", tools::textOption(arguments.network_range, "BLACK:WHITE"),
      "what the networks have for 0 and 255 DN");
  add("dark-channel", po::bool_switch(&arguments.dark_channel),
      "blind deblurring by the dark channel prior (Pan et al., CVPR 2016): many seconds a frame");
  BlindDeblurringOptions& dark = arguments.dark_channel_options;
  add("dark-channel-kernel",
      po::value(&dark.kernel_px)->default_value(dark.kernel_px)->value_name("PX"),
      "side of its kernel, odd; must hold the blur");
  const auto weight = [](double& target) {
    return po::value(&target)->default_value(target, decimal(target))->value_name("W");
  };
  add("dark-channel-lambda", weight(dark.weights.dark), "weight of the dark channel; 0: without");
  add("dark-channel-mu", weight(dark.weights.gradient), "weight of the gradient");
  add("dark-channel-gamma", weight(dark.kernel_weight), "weight of the kernel");
  add("dark-channel-patch",
      po::value(&dark.weights.patch_px)->default_value(dark.weights.patch_px)->value_name("PX"),
      "side of the neighbourhood whose darkest pixel counts");
  add("dark-channel-iterations",
      po::value(&dark.iterations)->default_value(dark.iterations)->value_name("N"),
      "estimates of image and kernel at each scale");
  options.add(methods);
}

po::options_description describeOptions(Arguments& arguments) {
  TopicNames& topics = arguments.topics;
  ScorerOptions& scorer = arguments.scorer;
  po::options_description options("Options");
  auto add = options.add_options();
  using tools::textOption;
  add("help,h", "print this");
  add("output,o", textOption(arguments.output, "FOLDER"),
      "where report.md, figures.csv and pictures go");
  add("config", po::value(&arguments.config)->value_name("YAML"),
      "parameters of the package's own output, e.g. cfg/davis346.yaml; not needed with --sequences "
      "or when both contrast thresholds are given as name:=value");
  add("sseq-model", textOption(scorer.sseq_folder, "FOLDER"),
      "SSEQ model: class.libsvm, regression_1..5.libsvm, feature_range.txt; without it no SSEQ");
  add("brisque-model", textOption(scorer.brisque_model_file, "FILE"), "BRISQUE model");
  add("brisque-range", textOption(scorer.brisque_range_file, "FILE"), "BRISQUE feature ranges");
  add("measures",
      po::value<std::string>()->value_name("EXTENT")->notifier(
          [&scorer](const std::string& name) { scorer.extent = measureExtentFromName(name); }),
      "reference: PSNR and SSIM; tracks: also what a feature tracker keeps; front-end: also "
      "feature "
      "inliers; all (default; choosing and judging: tracks)");
  add("full-reference-only", "the same as --measures reference: fast");
  add("skip",
      po::value(&scorer.first_frames_unscored)
          ->default_value(scorer.first_frames_unscored)
          ->value_name("N"),
      "first N frames of each recording are deblurred but not scored: what comes after learning");
  add("score-frames",
      po::value<std::string>()->value_name("N-M,...")->notifier(
          [&scorer](const std::string& text) { scorer.scored = FrameChoice(text); }),
      "only these frames of each recording are scored, from 1 on; inliers and tracks are those of "
      "frames that follow each other");
  const auto threshold = [](double& target) {
    return po::value(&target)->default_value(target, decimal(target))->value_name("C");
  };
  add("search-low", threshold(arguments.search.low),
      "searched contrast: smallest threshold [natural log]");
  add("search-high", threshold(arguments.search.high),
      "searched contrast: largest threshold [natural log]");
  tools::addForceOption(options, arguments.overwrite);

  po::options_description recording("Recordings");
  auto add_recording = recording.add_options();
  tools::addTopicOptions(recording, topics);
  add_recording("truth", textOption(arguments.truth_topic, "TOPIC"),
                "true sharp frames, stamped with the instant that they show; may be missing");
  add_recording("column", po::value(&arguments.columns)->value_name("NAME=OUT.bag[:TOPIC]"),
                "frames of another program as a further method, matched by their stamps; TOPIC: by "
                "default where deblur_bag writes; may be repeated");

  po::options_description simulated("Simulated sequences");
  auto add_simulated = simulated.add_options();
  add_simulated("sequences", po::value(&arguments.sequences)->value_name("SET"),
                "instead of a recording: twelve (six scenes by two seeds), choosing (many sensors, "
                "to choose parameters by) or judging (many sensors, never to choose by)");
  add_simulated("variant", po::value(&arguments.variants)->value_name("'NAME P:=V ...'"),
                "choosing and judging: a further method, by its name and parameters on top of the "
                "others; may be repeated");
  add_simulated("photographs", textOption(arguments.photographs, "FOLDER"),
                "choosing and judging: where Debian's mate-backgrounds has its mate/nature");
  add_simulated("frames", po::value(&arguments.frames)->value_name("N"),
                "frames of each sequence (default: twelve 10, choosing and judging 6)");
  add_simulated("seeds",
                po::value(&arguments.seeds)->default_value(arguments.seeds)->value_name("N"),
                "seeds of each scene, from 1");
  add_simulated("threshold-factor",
                po::value(&arguments.threshold_factor)
                    ->default_value(arguments.threshold_factor)
                    ->value_name("F"),
                "all methods get the true mean thresholds times this");
  add_simulated("video", po::value(&arguments.video_images)->value_name("N"),
                "instead: PSNR of the high-rate video at N instants of each exposure (odd), by the "
                "package as its parameters are");
  options.add(recording).add(simulated);
  addOtherMethods(options, arguments);
  return options;
}

tools::HelpText helpText() {
  return {
      "Usage: evaluate RECORDING... [options] [parameter:=value ...]\n"
      "       evaluate --sequences SET [options] [parameter:=value ...]\n\n"
      "Compares the blurry input, plain EDI, counter EDI, EDI with the contrast found by\n"
      "sharpness, the package's own output, and other methods that are asked for: table\n"
      "on standard output, report with pictures in a folder. Parameters given as name:=value\n"
      "come before the YAML file's. Latent images show the instant that the parameter\n"
      "reference names. Colour is turned to grey first; raw Bayer frames are measured as they\n"
      "are. --force removes the earlier report of a folder.\n",
      "0 done; 1 failed; 2 the recording was cut short or damaged."};
}

}  // namespace

bool parseArguments(int argc, char** argv, Arguments& arguments) {
  arguments.output = "evaluation";
  arguments.truth_topic = "/dvs/ground_truth/image_raw";
  const po::options_description visible = describeOptions(arguments);
  std::vector<std::string> words;
  auto values = tools::readCommandLine(argc, argv, visible, helpText(), &words);
  if (!values) {
    return false;
  }
  po::notify(*values);
  tools::sortWords(words, arguments.recordings, arguments.overrides);
  const bool simulated = !arguments.sequences.empty();
  if (simulated != arguments.recordings.empty()) {
    throw po::error("expected either a BAG or --sequences");
  }
  if (arguments.scorer.first_frames_unscored < 0) {
    throw po::error("--skip: expected 0 or more frames");
  }
  if (values->count("video") > 0 && arguments.sequences != "twelve") {
    throw po::error("--video goes with --sequences twelve, whose truth is known at any time");
  }
  if (values->count("frames") > 0 && arguments.frames < 1) {
    throw po::error("--frames: expected at least one frame");
  }
  if (!arguments.variants.empty() && (!simulated || arguments.sequences == "twelve")) {
    throw po::error("--variant goes with --sequences choosing and judging");
  }
  if (simulated && !arguments.columns.empty()) {
    throw po::error("--column goes with a recording");
  }
  const bool without_others =
      values->count("video") > 0 || (simulated && arguments.sequences != "twelve");
  if (without_others && (arguments.dark_channel || !arguments.networks.empty() ||
                         values->count("score-frames") > 0)) {
    throw po::error(
        "--network, --dark-channel and --score-frames go with a recording or --sequences twelve, "
        "without --video");
  }
  if (!(arguments.threshold_factor > 0.0)) {
    throw po::error("--threshold-factor: expected a number above 0");
  }
  if (values->count("full-reference-only") > 0) {
    arguments.scorer.extent = MeasureExtent::kReference;
  } else if (simulated && arguments.sequences != "twelve" && values->count("measures") == 0) {
    arguments.scorer.extent = MeasureExtent::kTracks;
  }
  arguments.command = "rosrun fast_edi evaluate";
  for (int i = 1; i < argc; ++i) {
    arguments.command += std::string(" ") + argv[i];
  }
  return true;
}

LoadedParameters loadParameters(const Arguments& arguments, const std::vector<std::string>& more) {
  YAML::Node root(YAML::NodeType::Map);
  if (!arguments.config.empty()) {
    try {
      root = YAML::LoadFile(arguments.config);
    } catch (const YAML::Exception& error) {
      throw ParameterError(arguments.config + ": " + error.what());
    }
  }
  applyOverrides(root, arguments.overrides);
  applyOverrides(root, more);
  if (!arguments.sequences.empty()) {
    // The simulated sensor's own thresholds replace these, see evaluateSequence().
    const SensorSettings sensor;
    if (!root["contrast_threshold_on"]) {
      root["contrast_threshold_on"] = sensor.thresholds.on;
    }
    if (!root["contrast_threshold_off"]) {
      root["contrast_threshold_off"] = sensor.thresholds.off;
    }
  }
  return parametersFromYaml(root, std::filesystem::path(arguments.config).parent_path().string());
}

int framesOfTwelve(const Arguments& arguments) {
  return arguments.frames > 0 ? arguments.frames : kSequenceFrames;
}

}  // namespace fast_edi::evaluate
