/// \file
/// `evaluate`: blurry input, plain EDI, the paper's counter EDI, EDI with searched contrast and
/// this package's own output, measured on a recording or on the fixed set of simulated sequences.

#include <filesystem>
#include <iomanip>
#include <iostream>
#include <list>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <ros/serialization.h>
#include <sensor_msgs/Image.h>
#include <std_msgs/Int32.h>
#include <yaml-cpp/yaml.h>
#include <boost/program_options.hpp>
#include <opencv2/core/utility.hpp>

#include "bags/recorded_frames.hpp"
#include "command_line.hpp"
#include "dark_channel/dark_channel_method.hpp"
#include "evaluation/evaluation.hpp"
#include "evaluation/frames_by_stamp.hpp"
#include "evaluation/method_options.hpp"
#include "evaluation/recorded_method.hpp"
#include "evaluation/report.hpp"
#include "fast_edi/bags/bag_deserialise.hpp"
#include "fast_edi/bags/bag_error.hpp"
#include "fast_edi/bags/message_source.hpp"
#include "fast_edi/bags/open_messages.hpp"
#include "fast_edi/bags/topic_names.hpp"
#include "fast_edi/config/parameters_from_yaml.hpp"
#include "fast_edi/messages/event_array.hpp"
#include "fast_edi/messages/message_conversion.hpp"
#include "networks/network_method.hpp"
#include "progress_bar.hpp"
#include "sequences/sequence_sets.hpp"
#include "sequences/sequences.hpp"
#include "sequences/set_evaluation.hpp"
#include "sequences/set_report.hpp"
#include "sequences/video_quality.hpp"

namespace {

namespace po = boost::program_options;
namespace tools = fast_edi::tools;
using tools::kDone;
using tools::kInputIncomplete;

struct Arguments {
  std::vector<std::string> recordings;
  std::string config;
  std::string output;
  std::string command;
  fast_edi::TopicNames topics;
  std::string truth_topic;
  fast_edi::ScorerOptions scorer;
  fast_edi::ContrastSearchOptions search;
  std::vector<std::string> overrides;
  std::vector<std::string> columns;   ///< NAME=OUT.bag[:TOPIC]
  std::vector<std::string> networks;  ///< NAME=MODEL.onnx
  std::string network_range = "0:1";
  bool dark_channel = false;
  fast_edi::BlindDeblurringOptions dark_channel_options;
  bool overwrite = false;
  std::string sequences;  ///< name of a set; empty: a recording
  std::vector<std::string> variants;
  std::string photographs = fast_edi::kPhotographFolder;
  int frames = 0;  ///< 0: as many as the set has
  int seeds = fast_edi::kSequenceSeeds;
  double threshold_factor = 1.0;
  int video_images = 0;
};

std::string decimal(double value) {
  std::ostringstream text;
  text << std::setprecision(4) << value;
  return text.str();
}

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
  fast_edi::BlindDeblurringOptions& dark = arguments.dark_channel_options;
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
  fast_edi::TopicNames& topics = arguments.topics;
  fast_edi::ScorerOptions& scorer = arguments.scorer;
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
      po::value<std::string>()->value_name("EXTENT")->notifier([&scorer](const std::string& name) {
        scorer.extent = fast_edi::measureExtentFromName(name);
      }),
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
          [&scorer](const std::string& text) { scorer.scored = fast_edi::FrameChoice(text); }),
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
      "Usage: evaluate BAG... [options] [parameter:=value ...]\n"
      "       evaluate --sequences SET [options] [parameter:=value ...]\n\n"
      "Compares the blurry input, plain EDI, counter EDI, EDI with the contrast found by\n"
      "sharpness, the package's own output, and other methods that are asked for: table\n"
      "on standard output, report with pictures in a folder. Parameters given as name:=value come "
      "before the "
      "YAML file's.\n"
      "Latent images show the instant that the parameter reference names. Colour is turned to grey "
      "first; raw Bayer\n"
      "frames are measured as they are. --force removes the earlier report of a folder.\n",
      "0 done; 1 failed; 2 the recording was cut short or damaged."};
}

/// \return false when help was asked for and given
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
    arguments.scorer.extent = fast_edi::MeasureExtent::kReference;
  } else if (simulated && arguments.sequences != "twelve" && values->count("measures") == 0) {
    arguments.scorer.extent = fast_edi::MeasureExtent::kTracks;
  }
  arguments.command = "rosrun fast_edi evaluate";
  for (int i = 1; i < argc; ++i) {
    arguments.command += std::string(" ") + argv[i];
  }
  return true;
}

/// \param more overrides that come before all others
fast_edi::LoadedParameters loadParameters(const Arguments& arguments,
                                          const std::vector<std::string>& more = {}) {
  YAML::Node root(YAML::NodeType::Map);
  if (!arguments.config.empty()) {
    try {
      root = YAML::LoadFile(arguments.config);
    } catch (const YAML::Exception& error) {
      throw fast_edi::ParameterError(arguments.config + ": " + error.what());
    }
  }
  fast_edi::applyOverrides(root, arguments.overrides);
  fast_edi::applyOverrides(root, more);
  if (!arguments.sequences.empty()) {
    // The simulated sensor's own thresholds replace these, see evaluateSequence().
    const fast_edi::SensorSettings sensor;
    if (!root["contrast_threshold_on"]) {
      root["contrast_threshold_on"] = sensor.thresholds.on;
    }
    if (!root["contrast_threshold_off"]) {
      root["contrast_threshold_off"] = sensor.thresholds.off;
    }
  }
  return fast_edi::parametersFromYaml(
      root, std::filesystem::path(arguments.config).parent_path().string());
}

/// \return false for a message that contradicts itself
bool feed(const fast_edi::BagMessage& message, const fast_edi::TopicNames& topics,
          fast_edi::MethodComparison& comparison) {
  const auto now_ns = static_cast<std::int64_t>(message.time.toNSec());
  const std::string& topic = message.connection->topic;
  comparison.advance(now_ns);
  try {
    if (topic == topics.events) {
      const auto array = fast_edi::deserialise<fast_edi::EventArrayView>(message);
      comparison.addEvents(array->events(), fast_edi::sensorSize(*array), array->header.seq,
                           now_ns);
    } else if (topic == topics.image) {
      const auto image = fast_edi::deserialise<sensor_msgs::Image>(message);
      if (fast_edi::readImage(*image).verdict == fast_edi::ImageVerdict::kMalformed) {
        return false;
      }
      comparison.addFrame(static_cast<std::int64_t>(image->header.stamp.toNSec()),
                          fast_edi::toMono8(*image), now_ns);
    } else if (topic == topics.exposure) {
      comparison.addExposure(fast_edi::deserialise<std_msgs::Int32>(message)->data, now_ns);
    }
  } catch (const ros::serialization::StreamOverrunException&) {
    return false;
  }
  return true;
}

std::vector<std::string> notesOf(const fast_edi::FrameScorer& scorer) {
  std::vector<std::string> notes;
  for (const std::string& missing : scorer.missing()) {
    notes.push_back("Not measured: " + missing);
  }
  return notes;
}

void printGroups(const std::vector<fast_edi::EvaluationGroup>& groups,
                 const std::vector<std::string>& notes) {
  fast_edi::EvaluationGroup all{"all", {}};
  for (const fast_edi::EvaluationGroup& group : groups) {
    std::cout << group.name << "\n\n";
    if (group.members.size() > 1) {
      for (const fast_edi::Measure measure : {fast_edi::Measure::kPsnr, fast_edi::Measure::kSsim}) {
        std::cout << fast_edi::describe(measure).name << "\n";
        fast_edi::printMemberTable(std::cout, group, measure);
        std::cout << "\n";
      }
    }
    fast_edi::printMeasureTable(std::cout, group);
    std::cout << "\n";
    all.members.insert(all.members.end(), group.members.begin(), group.members.end());
  }
  fast_edi::printRuntimeTable(std::cout, all);
  std::cout << "\n";
  for (const std::string& note : notes) {
    std::cout << note << "\n";
  }
}

/// What --dark-channel, --network and --column ask for. Adds to \p incomplete what is wrong with
/// the recordings.
fast_edi::OtherMethods otherMethods(const Arguments& arguments,
                                    std::vector<std::string>& incomplete) {
  std::vector<std::string> names = fast_edi::methodNames();
  fast_edi::OtherMethods methods;
  if (arguments.dark_channel) {
    const auto bar = std::make_shared<fast_edi::ProgressBar>("one frame ");
    methods.push_back(std::make_unique<fast_edi::DarkChannelMethod>(
        arguments.dark_channel_options, [bar](double done) {
          constexpr double kSteps = 1000.0;
          bar->update(static_cast<std::uint64_t>(done * kSteps),
                      static_cast<std::uint64_t>(kSteps));
        }));
    names.push_back(methods.back()->name());
  }
  const fast_edi::NetworkRange range = fast_edi::networkRange(arguments.network_range);
  for (const std::string& text : arguments.networks) {
    const fast_edi::NamedFile network = fast_edi::namedFile("--network", text, names);
    methods.push_back(std::make_unique<fast_edi::NetworkMethod>(network.name, network.file, range));
  }
  for (const std::string& text : arguments.columns) {
    const fast_edi::NamedFile column = fast_edi::namedFile("--column", text, names);
    const fast_edi::RecordedTopic from =
        fast_edi::recordedTopic(column.file, arguments.topics.outputImage());
    fast_edi::RecordedFrames frames = fast_edi::requireFrames(from.recording, from.topic);
    if (frames.malformed > 0) {
      incomplete.push_back(column.name + ": " + std::to_string(frames.malformed) +
                           " malformed frames in " + from.recording + " left out");
    }
    if (!frames.damage.empty()) {
      incomplete.push_back(column.name + ": " + from.recording + " is cut short or damaged");
    }
    methods.push_back(std::make_unique<fast_edi::RecordedMethod>(
        column.name, from.recording + " " + from.topic, std::move(frames.by_stamp)));
  }
  return methods;
}

int evaluateBag(const Arguments& arguments) {
  const std::unique_ptr<fast_edi::MessageSource> recording =
      fast_edi::openMessages(arguments.recordings);
  fast_edi::MessageSource& reader = *recording;
  const fast_edi::LoadedParameters loaded =
      tools::loadParametersFor(reader, arguments.config, arguments.overrides);
  tools::printWarnings(loaded);
  std::vector<std::string> incomplete;
  const fast_edi::OtherMethods others = otherMethods(arguments, incomplete);
  fast_edi::prepareReportFolder(arguments.output, arguments.overwrite);
  const fast_edi::DeblurParameters& parameters = loaded.deblur;
  const std::string faults = fast_edi::checkTopics(arguments.topics, reader.connections());
  if (!faults.empty()) {
    throw fast_edi::BagError(fast_edi::nameOf(arguments.recordings) + ": " + faults);
  }
  const fast_edi::RecordedFrames truth =
      fast_edi::readFrames(arguments.recordings, arguments.truth_topic);
  const fast_edi::FrameScorer scorer(arguments.scorer);
  int without_truth = 0;
  fast_edi::EvaluationRecorder recorder(
      std::filesystem::path(arguments.recordings.front()).filename().string(), scorer,
      [&truth, &without_truth](std::int64_t stamp_ns) {
        const auto found = fast_edi::frameAt(truth.by_stamp, stamp_ns);
        without_truth += found == truth.by_stamp.end() ? 1 : 0;
        return found != truth.by_stamp.end() ? found->second : cv::Mat();
      },
      others);
  fast_edi::MethodComparison comparison(
      parameters, arguments.search,
      [&recorder](const fast_edi::ComparedFrame& frame) { recorder.add(frame); });
  std::uint64_t malformed = truth.malformed;
  {
    fast_edi::ProgressBar bar("evaluating");
    fast_edi::BagMessage message;
    while (reader.next(message)) {
      malformed += feed(message, arguments.topics, comparison) ? 0 : 1;
      bar.update(reader.position(), reader.length());
    }
    comparison.finish();
  }

  const fast_edi::Evaluation& evaluation = recorder.evaluation();
  std::vector<std::string> notes = notesOf(scorer);
  notes.push_back("Contrast thresholds: ON " + decimal(parameters.thresholds.on) + ", OFF " +
                  decimal(parameters.thresholds.off) +
                  "; searched: " + decimal(evaluation.meanSearchedContrast()) + " in the mean");
  if (truth.by_stamp.empty()) {
    notes.push_back("No true frames on " + arguments.truth_topic + ": no PSNR, no SSIM");
  } else if (without_truth > 0) {
    notes.push_back(std::to_string(without_truth) + " frames without a true frame on " +
                    arguments.truth_topic +
                    " that has the stamp of the latent image (see the parameter reference)");
  }
  for (const auto& [reason, count] : evaluation.left_out) {
    notes.push_back(std::to_string(count) + " frames left out: " + reason);
  }
  for (const std::unique_ptr<fast_edi::OtherMethod>& other : others) {
    const std::vector<std::string> more = other->notes();
    notes.insert(notes.end(), more.begin(), more.end());
  }
  notes.insert(notes.end(), incomplete.begin(), incomplete.end());
  if (evaluation.frames.empty()) {
    throw std::runtime_error(
        fast_edi::nameOf(arguments.recordings) + ": no frame could be deblurred" +
        (evaluation.left_out.empty() ? std::string()
                                     : " (" + evaluation.left_out.begin()->first + ")"));
  }
  const std::vector<fast_edi::EvaluationGroup> groups = {{evaluation.name, {&evaluation}}};
  printGroups(groups, notes);
  std::cout << "written: "
            << fast_edi::writeReport(arguments.output,
                                     {"Evaluation of " + evaluation.name, arguments.command, notes},
                                     groups)
            << "\n";
  tools::printDamage(fast_edi::nameOf(arguments.recordings), reader.damage());
  tools::printMalformed(malformed);
  return reader.damage().empty() && malformed == 0 && incomplete.empty() ? kDone : kInputIncomplete;
}

int framesOfTwelve(const Arguments& arguments) {
  return arguments.frames > 0 ? arguments.frames : fast_edi::kSequenceFrames;
}

int evaluateSequences(const Arguments& arguments, const fast_edi::DeblurParameters& parameters) {
  const int frames = framesOfTwelve(arguments);
  std::vector<std::string> incomplete;  // nothing, without --column
  const fast_edi::OtherMethods others = otherMethods(arguments, incomplete);
  fast_edi::prepareReportFolder(arguments.output, arguments.overwrite);
  const std::vector<fast_edi::EvaluationSequence> sequences =
      fast_edi::evaluationSequences(frames, arguments.seeds);
  const fast_edi::FrameScorer scorer(arguments.scorer);
  std::list<fast_edi::Evaluation> evaluations;
  std::vector<fast_edi::EvaluationGroup> groups = {{"sequences for tuning", {}},
                                                   {"sequences not tuned on", {}}};
  {
    fast_edi::ProgressBar bar("evaluating");
    const std::uint64_t total = sequences.size() * static_cast<std::uint64_t>(frames);
    std::uint64_t done_before = 0;
    for (const fast_edi::EvaluationSequence& sequence : sequences) {
      evaluations.push_back(fast_edi::evaluateSequence(
          sequence, parameters, arguments.threshold_factor, arguments.search, scorer, others,
          [&](int done) { bar.update(done_before + static_cast<std::uint64_t>(done), total); }));
      groups[sequence.for_tuning ? 0 : 1].members.push_back(&evaluations.back());
      done_before += static_cast<std::uint64_t>(frames);
    }
  }
  std::vector<std::string> notes = notesOf(scorer);
  for (const fast_edi::Evaluation& evaluation : evaluations) {
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
            << fast_edi::writeReport(
                   arguments.output,
                   {"Evaluation on simulated sequences", arguments.command, notes}, groups)
            << "\n";
  return kDone;
}

/// A variant from its words on the command line: "name key:=value key:=value".
fast_edi::Variant variantFrom(const Arguments& arguments, const std::string& text) {
  std::istringstream stream(text);
  fast_edi::Variant variant;
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

int evaluateSet(const Arguments& arguments, fast_edi::SequenceSet set,
                const fast_edi::DeblurParameters& parameters) {
  fast_edi::prepareReportFolder(arguments.output, arguments.overwrite);
  const std::string scores = arguments.output + "/" + arguments.sequences + ".csv";
  if (!arguments.overwrite && std::filesystem::exists(scores)) {
    throw std::runtime_error("cannot write " + scores +
                             ": it exists already (--force replaces it)");
  }
  std::vector<fast_edi::Variant> variants = {{"ours", parameters}};
  for (const std::string& text : arguments.variants) {
    variants.push_back(variantFrom(arguments, text));
  }
  const int frames = arguments.frames > 0 ? arguments.frames : fast_edi::kSetFrames;
  const fast_edi::SequenceSetContents contents =
      fast_edi::sequencesOf(set, frames, arguments.photographs);
  const fast_edi::FrameScorer scorer(arguments.scorer);
  fast_edi::SetEvaluation evaluation;
  evaluation.columns = fast_edi::columnNames(variants);
  {
    fast_edi::ProgressBar bar("evaluating");
    const std::uint64_t total = contents.sequences.size() * static_cast<std::uint64_t>(frames);
    for (fast_edi::SetSequence sequence : contents.sequences) {
      const std::uint64_t done_before =
          evaluation.results.size() * static_cast<std::uint64_t>(frames);
      sequence.threshold_factor *= arguments.threshold_factor;
      evaluation.results.push_back(fast_edi::evaluateVariants(
          sequence, variants, scorer,
          [&](int done) { bar.update(done_before + static_cast<std::uint64_t>(done), total); }));
    }
  }
  for (const fast_edi::Measure measure : {fast_edi::Measure::kPsnr, fast_edi::Measure::kSsim}) {
    fast_edi::printSetMembers(std::cout, evaluation, measure);
    std::cout << "\n";
  }
  fast_edi::printSetFactors(std::cout, evaluation);
  if (arguments.scorer.extent >= fast_edi::MeasureExtent::kTracks) {
    fast_edi::printSetShares(std::cout, evaluation);
  }
  fast_edi::printSetMeasures(std::cout, evaluation);
  std::cout << "\n";
  fast_edi::printSetRuntimes(std::cout, evaluation);
  for (const std::string& missing : contents.missing) {
    std::cout << "Left out: " << missing << "\n";
  }
  for (const fast_edi::SetResult& result : evaluation.results) {
    if (result.left_out > 0) {
      std::cout << result.name << ": " << result.left_out << " frames passed through\n";
    }
  }
  for (const std::string& note : notesOf(scorer)) {
    std::cout << note << "\n";
  }
  std::filesystem::create_directories(arguments.output);
  fast_edi::writeSetScores(scores, evaluation);
  std::cout << "written: " << scores << "\n";
  return kDone;
}

int evaluateVideo(const Arguments& arguments, const fast_edi::DeblurParameters& parameters) {
  std::vector<fast_edi::VideoQuality> qualities;
  const int frames = framesOfTwelve(arguments);
  const auto sequences = fast_edi::evaluationSequences(frames, arguments.seeds);
  const std::uint64_t total = sequences.size() * static_cast<std::uint64_t>(frames);
  {
    fast_edi::ProgressBar bar("evaluating");
    for (const fast_edi::EvaluationSequence& sequence : sequences) {
      const std::uint64_t done_before = qualities.size() * static_cast<std::uint64_t>(frames);
      qualities.push_back(fast_edi::videoQuality(
          sequence, parameters, arguments.video_images, arguments.scorer.first_frames_unscored,
          [&](int done) { bar.update(done_before + static_cast<std::uint64_t>(done), total); }));
    }
  }
  fast_edi::printVideoTable(std::cout, qualities);
  return kDone;
}

int run(const Arguments& arguments) {
  // Run times are those of one thread; results do not depend on how many cores there are.
  cv::setNumThreads(1);
  if (arguments.sequences.empty() && arguments.video_images == 0) {
    return evaluateBag(arguments);
  }
  const fast_edi::LoadedParameters parameters = loadParameters(arguments);
  tools::printWarnings(parameters);
  if (arguments.video_images != 0) {
    return evaluateVideo(arguments, parameters.deblur);
  }
  const fast_edi::SequenceSet set = fast_edi::sequenceSetFromName(arguments.sequences);
  return set == fast_edi::SequenceSet::kTwelve ? evaluateSequences(arguments, parameters.deblur)
                                               : evaluateSet(arguments, set, parameters.deblur);
}

}  // namespace

int main(int argc, char** argv) {
  return tools::runTool("evaluate", [argc, argv] {
    Arguments arguments;
    return parseArguments(argc, argv, arguments) ? run(arguments) : kDone;
  });
}
