/// \file
/// `tune`: parameters by eye. A frame of a recording, deblurred again with each change of a slider.

#include <algorithm>
#include <cstdint>
#include <iostream>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <boost/program_options.hpp>
#include <opencv2/imgcodecs.hpp>

#include "command_line.hpp"
#include "fast_edi/bags/open_messages.hpp"
#include "fast_edi/base/number_text.hpp"
#include "fast_edi/config/parameter_file.hpp"
#include "fast_edi/messages/image_pixels.hpp"
#include "fast_edi/messages/message_conversion.hpp"
#include "replay/frame_replay.hpp"
#include "tuning/first_frame.hpp"
#include "tuning/shell_text.hpp"
#include "tuning/tuning_picture.hpp"
#include "tuning/tuning_session.hpp"
#include "tuning/tuning_sliders.hpp"
#include "validation/proposed_parameters.hpp"
#include "validation_pass.hpp"
#include "window/tuning_window.hpp"

namespace fast_edi {
namespace {

namespace po = boost::program_options;

/// Messages are recorded this long after their stamps at most.
constexpr std::int64_t kRecordDelay_ns = RecordingSurvey::kLargestDelay_ns;
constexpr char kTitle[] = "fast_edi tune";

struct Arguments {
  std::vector<std::string> recordings;
  std::string config;
  std::vector<std::string> overrides;
  TopicNames topics;
  std::optional<std::size_t> frame;
  std::string save = "tuned.yaml";
  std::string screenshot;
  bool as_given = false;
  bool overwrite = false;
};

std::string keysText() {
  constexpr std::size_t kWidth = 9;
  std::string text;
  for (const TuningKey& key : kTuningKeys) {
    std::string keys = key.keys;
    keys.resize(kWidth, ' ');
    text += "  " + keys + key.what + "\n";
  }
  return text;
}

/// \return false when help was asked for and given
bool parseArguments(int argc, char** argv, Arguments& arguments) {
  po::options_description visible("Options");
  std::int64_t frame = -1;
  visible.add_options()("help,h", "print this")("config",
                                                po::value(&arguments.config)->value_name("YAML"),
                                                "parameters to start from, e.g. cfg/davis346.yaml")(
      "frame", po::value(&frame)->value_name("N"),
      "frame to begin with, counted from 0; by default the one with most events")(
      "save", tools::textOption(arguments.save, "YAML"), "file for the parameters, written by s")(
      "screenshot", po::value(&arguments.screenshot)->value_name("PNG"),
      "write the picture of the frame, open no window and end; needs no display")(
      "as-given", po::bool_switch(&arguments.as_given),
      "start from the parameters as they are given, without what validate_bag proposes");
  tools::addTopicOptions(visible, arguments.topics);
  tools::addForceOption(visible, arguments.overwrite);
  std::vector<std::string> words;
  auto values = tools::readCommandLine(
      argc, argv, visible,
      {"Usage: tune RECORDING... [--config cfg/davis346.yaml] [options] [parameter:=value ...]\n\n"
       "Shows a frame of a recording, its events and the deblurred frame, with sliders for the "
       "contrast\nthresholds, the exposure where it is not recorded, the time offset and the "
       "strengths of filters.\nStarts from what validate_bag proposes; parameters given as "
       "name:=value come before that. At the\nend, prints the command that deblurs the recording "
       "like that.\n\nKeys in the window:\n" +
           keysText(),
       "0 done; 1 failed."},
      &words);
  if (!values) {
    return false;
  }
  po::notify(*values);
  tools::requireRecordings(words, arguments.recordings, arguments.overrides);
  if (values->count("frame") > 0) {
    if (frame < 0) {
      throw po::error("--frame " + std::to_string(frame) + ": expected a number from 0 on");
    }
    arguments.frame = static_cast<std::size_t>(frame);
  }
  return true;
}

/// What the recording is, and the parameters that tuning starts from.
struct Start {
  TopicNames topics;
  std::vector<std::string> overrides;  ///< proposals, then those given
  std::vector<std::int32_t> exposures_us;
  TuningRanges ranges;
  std::int64_t longest_exposure_ns = 0;
  std::size_t busiest_frame = 0;
  LoadedParameters loaded;
};

TopicNames topicsOf(const Arguments& arguments, const MessageSource& recording) {
  TopicNames wanted = arguments.topics;
  wanted.output = "/tune";  // writes none: topics of deblurred frames may be there already
  const TopicNames topics = guessTopics(wanted, recording.connections());
  std::cout << guessText(wanted, topics, recording.connections());
  const std::string faults = checkTopics(topics, recording.connections());
  if (!faults.empty()) {
    throw std::runtime_error(nameOf(arguments.recordings) + ": " + faults);
  }
  return topics;
}

/// Reads the recording through: its frames, and what validate_bag proposes for it.
Start startOf(const Arguments& arguments) {
  const std::unique_ptr<MessageSource> recording = openMessages(arguments.recordings);
  Start start;
  start.topics = topicsOf(arguments, *recording);
  const tools::ValidationStart given =
      tools::validationStart(*recording, arguments.config, arguments.overrides);
  RecordingValidator validator(given.parameters, given.pipeline);
  const tools::ReadResult read =
      tools::readThrough(arguments.recordings, start.topics, "looking through", validator);
  if (arguments.as_given) {
    validator.endSurvey();
  } else {
    const ValidationReport report =
        tools::finishValidation(arguments.recordings, start.topics, validator);
    start.overrides = proposedOverrides(report.proposal, validator.survey());
    std::cout << "proposed by validate_bag: " << shellText(start.overrides) << "\n";
    if (!report.findings.empty()) {
      std::cout << "findings of validate_bag, which says more: " << report.findings.size() << "\n";
    }
    if (!given.parameters.thresholds_given && !report.proposal.thresholds) {
      std::cerr
          << "warning: contrast thresholds are not given, and validate_bag proposes none: starting "
             "from "
          << given.parameters.thresholds.on << "\n";
    }
  }
  if (!given.parameters.thresholds_given) {
    const std::string value = numberText(given.parameters.thresholds.on);
    start.overrides.insert(start.overrides.begin(),
                           {"contrast_threshold_on:=" + value, "contrast_threshold_off:=" + value});
  }
  start.overrides.insert(start.overrides.end(), arguments.overrides.begin(),
                         arguments.overrides.end());
  start.loaded = tools::loadParametersFor(*recording, arguments.config, start.overrides);
  tools::printDamage(nameOf(arguments.recordings), read.damage);
  tools::printMalformed(read.malformed);
  const DeblurParameters& deblur = start.loaded.deblur;
  for (const LoggedFrame& frame : validator.survey().frames().frames()) {
    start.exposures_us.push_back(
        static_cast<std::int32_t>(frame.length_ns / kNanosecondsPerMicrosecond));
    start.longest_exposure_ns = std::max(start.longest_exposure_ns, frame.length_ns);
  }
  const std::int64_t period_ns = validator.survey().frames().periodNs();
  start.ranges.exposures_known =
      start.longest_exposure_ns > 0 && deblur.exposure_source == ExposureSource::kTopic;
  // No exposure is longer than the time from frame to frame, but what is given counts.
  start.longest_exposure_ns =
      std::max({start.longest_exposure_ns, period_ns, deblur.exposure_time_ns});
  start.ranges.longest_exposure_us = start.longest_exposure_ns / kNanosecondsPerMicrosecond;
  start.ranges.time_offset_us =
      static_cast<double>(deblur.time_offset_ns) / static_cast<double>(kNanosecondsPerMicrosecond);
  start.busiest_frame = busiestFrame(validator.survey(), deblur.time_offset_ns);
  return start;
}

/// Grey for an encoding that is not known.
cv::Mat pictureOf(const sensor_msgs::Image& image) {
  constexpr double kGrey = 128.0;
  return readImage(image).verdict == ImageVerdict::kSupported
             ? colourPixels(image)
             : cv::Mat(static_cast<int>(image.height), static_cast<int>(image.width), CV_8UC3,
                       cv::Scalar::all(kGrey));
}

std::string describe(const ReplayedFrame& frame) {
  constexpr int kDecimals = 2;
  if (!frame.output) {
    return "no output: its stamp is not later than that of the frame before";
  }
  const OutputFrame& result = frame.result;
  if (!result.deblurred) {
    return std::string("passed through: ") + toString(result.pass_reason);
  }
  const double length_ms = static_cast<double>(result.exposure.length()) /
                           static_cast<double>(kNanosecondsPerMillisecond);
  return "exposure " + fixedText(length_ms, kDecimals) + " ms, " + std::to_string(result.events) +
         " events";
}

/// Frame and picture of a session.
class View {
 public:
  View(const Arguments& arguments, const Start& start)
      : window_([&arguments] { return openMessages(arguments.recordings); }, start.topics,
                start.exposures_us,
                {mostFramesBefore(), start.longest_exposure_ns + kRecordDelay_ns +
                                         kOffsetRange_us * kNanosecondsPerMicrosecond}) {}

  /// Deblurs the session's frame.
  void update(const TuningSession& session) {
    if (!window_.moveTo(session.frame())) {
      throw std::runtime_error("frame " + std::to_string(session.frame()) +
                               " is not there any more: was the recording changed?");
    }
    const ReplayedFrame replayed = replayFrame(window_, session.parameters().loaded());
    frame_.blurry = pictureOf(*replayed.input);
    frame_.deblurred = replayed.output ? pictureOf(*replayed.output) : cv::Mat();
    frame_.events = replayed.events;
    frame_.description = describe(replayed);
  }
  cv::Mat draw(const TuningSession& session) const { return drawTuning(session, frame_); }

 private:
  FrameWindow window_;
  TunedFrame frame_;
};

std::string configurationText(const TuningSession& session) {
  return "# By eye, from rosrun fast_edi tune. Nothing is learned beyond it: refine_contrast and\n"
         "# refine_delay: true would learn from there.\n" +
         session.parameters().yaml();
}

/// \return whether it was saved
bool save(const Arguments& arguments, TuningSession& session) {
  try {
    ParameterFile(arguments.save).write(configurationText(session));
  } catch (const std::runtime_error& error) {
    std::cerr << "tune: " << error.what() << "\n";
    session.setMessage(error.what());
    return false;
  }
  std::cout << "written: " << arguments.save << std::endl;
  session.setMessage("saved to " + arguments.save);
  return true;
}

/// \param saved configuration of the file, empty if none was written
void printCommand(const Arguments& arguments, const Start& start, const TuningSession& session,
                  const std::string& saved) {
  std::vector<std::string> words = {"rosrun", "fast_edi", "deblur_bag", "--in"};
  words.insert(words.end(), arguments.recordings.begin(), arguments.recordings.end());
  words.insert(words.end(), {"--out", "deblurred.bag"});
  const TopicNames names;
  for (const auto& [option, topic, name] :
       {std::tuple("--events", start.topics.events, names.events),
        {"--image", start.topics.image, names.image},
        {"--exposure", start.topics.exposure, names.exposure}}) {
    if (topic != name) {
      words.insert(words.end(), {option, topic});
    }
  }
  if (saved == configurationText(session)) {
    words.insert(words.end(), {"--config", arguments.save});
  } else {
    if (!arguments.config.empty()) {
      words.insert(words.end(), {"--config", arguments.config});
    }
    const std::vector<std::string> overrides = session.parameters().overrides();
    words.insert(words.end(), overrides.begin(), overrides.end());
  }
  std::cout << "to deblur the recording with these parameters:\n" << shellText(words) << std::endl;
}

/// \return the configuration that was saved last, empty if none was
std::string runWindow(const Arguments& arguments, TuningSession& session, View& view) {
  std::string saved;
  TuningEffect pending = TuningEffect::kDeblur;
  TuningWindow window(kTitle, session.sliders(), [&](std::size_t slider, int position) {
    const TuningEffect effect = session.moveSlider(slider, position);
    pending = effect == TuningEffect::kNone ? pending : effect;
  });
  const auto placeSliders = [&] {
    for (std::size_t i = 0; i < session.sliders().size(); ++i) {
      window.moveSlider(i, session.position(i));
    }
  };
  placeSliders();
  while (window.isOpen()) {
    if (pending == TuningEffect::kDeblur) {
      view.update(session);
    }
    if (pending != TuningEffect::kNone) {
      window.show(view.draw(session), kTitle + (": " + tuningTitle(session)));
      pending = TuningEffect::kNone;
    }
    const int key = window.waitKey();
    if (key == TuningWindow::kNoKey) {
      continue;
    }
    const TuningEffect effect = session.press(key);
    switch (effect) {
      case TuningEffect::kEnd:
        return saved;
      case TuningEffect::kSave:
        if (save(arguments, session)) {
          saved = configurationText(session);
        }
        pending = TuningEffect::kRedraw;
        break;
      case TuningEffect::kMarks:
        placeSliders();
        pending = TuningEffect::kDeblur;
        break;
      case TuningEffect::kNone:
      case TuningEffect::kRedraw:
      case TuningEffect::kDeblur:
        pending = effect;
        break;
    }
  }
  return saved;
}

int run(const Arguments& arguments) {
  if (arguments.screenshot.empty()) {
    tools::requireFree(arguments.save, arguments.overwrite);
    requireDisplay();
  } else {
    tools::requireFree(arguments.screenshot, arguments.overwrite);
  }
  const Start start = startOf(arguments);
  const std::size_t frames = start.exposures_us.size();
  const std::size_t frame = arguments.frame.value_or(start.busiest_frame);
  if (frame >= frames) {
    throw std::runtime_error(nameOf(arguments.recordings) +
                             (frames == 0 ? " has no frames on " + start.topics.image
                                          : ": --frame " + std::to_string(frame) +
                                                ", expected 0.." + std::to_string(frames - 1)));
  }
  TuningSession session(TunedParameters(arguments.config, start.overrides, start.loaded),
                        tuningSliders(start.ranges), frames, frame);
  View view(arguments, start);
  std::string saved;
  if (arguments.screenshot.empty()) {
    saved = runWindow(arguments, session, view);
  } else {
    view.update(session);
    if (!cv::imwrite(arguments.screenshot, view.draw(session))) {
      throw std::runtime_error("cannot write " + arguments.screenshot);
    }
    std::cout << "written: " << arguments.screenshot << "\n";
  }
  printCommand(arguments, start, session, saved);
  return tools::kDone;
}

}  // namespace
}  // namespace fast_edi

int main(int argc, char** argv) {
  return fast_edi::tools::runTool("tune", [argc, argv] {
    fast_edi::Arguments arguments;
    return fast_edi::parseArguments(argc, argv, arguments) ? fast_edi::run(arguments)
                                                           : fast_edi::tools::kDone;
  });
}
