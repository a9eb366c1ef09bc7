#include "tools/tune/tune_arguments.hpp"

#include <cstdint>

#include <boost/program_options.hpp>

#include "command_line.hpp"
#include "tuning/tuning_session.hpp"

namespace fast_edi::tune {
namespace {

namespace po = boost::program_options;

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

}  // namespace

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

}  // namespace fast_edi::tune
