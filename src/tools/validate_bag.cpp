/// \file
/// `validate_bag`: looks through a recording for what breaks deblurring and says what to set.

#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include <boost/program_options.hpp>
#include <opencv2/imgcodecs.hpp>

#include "command_line.hpp"
#include "evaluation/plot.hpp"
#include "fast_edi/bags/message_source.hpp"
#include "fast_edi/bags/open_messages.hpp"
#include "fast_edi/bags/topic_names.hpp"
#include "fast_edi/recording/open_recording.hpp"
#include "validation/recording_validator.hpp"
#include "validation/report_text.hpp"
#include "validation_pass.hpp"

namespace {

namespace fs = std::filesystem;
namespace po = boost::program_options;
namespace tools = fast_edi::tools;
using tools::kDone;
using tools::kFindings;

struct Arguments {
  std::vector<std::string> recordings;
  std::string config;
  std::string output;
  fast_edi::TopicNames topics;
  std::vector<std::string> overrides;
  bool overwrite = false;
};

/// \return false when help was asked for and given
bool parseArguments(int argc, char** argv, Arguments& arguments) {
  fast_edi::TopicNames& topics = arguments.topics;
  po::options_description visible("Options");
  visible.add_options()("help,h", "print this")(
      "config", po::value(&arguments.config)->value_name("YAML"),
      "parameters to compare the recording with, e.g. cfg/davis346.yaml; without one, "
      "thresholds are not checked")("output", po::value(&arguments.output)->value_name("FOLDER"),
                                    "folder for a plot of the agreement of frames and events over "
                                    "the shift of the exposures");
  tools::addTopicOptions(visible, topics);
  tools::addForceOption(visible, arguments.overwrite);
  std::vector<std::string> words;
  auto values = tools::readCommandLine(
      argc, argv, visible,
      {"Usage: validate_bag RECORDING... [--config cfg/davis346.yaml] [options] [parameter:=value "
       "...]\n\n"
       "Looks through a recording of any format for what breaks deblurring. For each finding it "
       "prints what\n"
       "was expected, what was found and what to set, and at the end lines for a YAML file.\n"
       "Topics of other names are taken when they are the only ones of their type.\n",
       "0 no findings; 1 failed; 2 findings."},
      &words);
  if (!values) {
    return false;
  }
  po::notify(*values);
  tools::requireRecordings(words, arguments.recordings, arguments.overrides);
  return true;
}

/// By the format of the recording.
fast_edi::RecordingOrigin originOf(const std::string& recording) {
  switch (fast_edi::formatOf(recording)) {
    case fast_edi::RecordingFormat::kRosbag:
      return fast_edi::RecordingOrigin::kRosDriver;
    case fast_edi::RecordingFormat::kAedat4:
      return fast_edi::RecordingOrigin::kDv;
    default:
      return fast_edi::RecordingOrigin::kOther;
  }
}

void addFileFindings(const tools::ReadResult& pass, fast_edi::RecordingOrigin origin,
                     std::vector<fast_edi::Finding>& findings) {
  if (!pass.damage.empty()) {
    findings.push_back({"file-damaged", "a complete recording",
                        fast_edi::textOf("%zu places cannot be read, the first at byte %llu: %s",
                                         pass.damage.size(),
                                         static_cast<unsigned long long>(pass.damage[0].offset),
                                         pass.damage[0].what.c_str()),
                        std::string("deblur_bag reads what is left") +
                            (origin == fast_edi::RecordingOrigin::kRosDriver
                                 ? "; rosbag reindex mends a bag that was cut short"
                                 : "")});
  }
  if (pass.malformed > 0) {
    findings.push_back(
        {"messages-malformed", "messages as long as they say",
         fast_edi::textOf("%llu are shorter", static_cast<unsigned long long>(pass.malformed)),
         "record again; these messages are not used"});
  }
}

std::string curvePath(const Arguments& arguments) {
  return (fs::path(arguments.output) / "shift.png").string();
}

void drawCurve(const std::string& path, const fast_edi::TimingEstimate& timing) {
  fs::create_directories(fs::path(path).parent_path());
  if (timing.curve.empty()) {
    std::cerr << "warning: nothing to draw: " << timing.reason << "\n";
    return;
  }
  fast_edi::PlotSeries correlation{"correlation", {}};
  fast_edi::PlotSeries cost{"cost (log residual)", {}};
  for (const fast_edi::ShiftPoint& point : timing.curve) {
    correlation.values.emplace_back(point.correlation);
    cost.values.emplace_back(point.cost);
  }
  const cv::Mat plot = fast_edi::linePlot(
      {"Agreement of frames and events over the shift of the exposures",
       fast_edi::textOf("from %.1f ms to %.1f ms behind the stamps",
                        timing.curve.front().shift_ns * 1e-6, timing.curve.back().shift_ns * 1e-6),
       ""},
      {correlation, cost});
  if (!cv::imwrite(path, plot)) {
    throw std::runtime_error("cannot write " + path);
  }
  std::cout << "written: " << path << "\n";
}

int run(const Arguments& arguments) {
  if (!arguments.output.empty()) {
    tools::requireFree(curvePath(arguments), arguments.overwrite);
  }
  std::unique_ptr<fast_edi::MessageSource> recording = fast_edi::openMessages(arguments.recordings);
  tools::ValidationStart start =
      tools::validationStart(*recording, arguments.config, arguments.overrides);
  start.parameters.origin = originOf(arguments.recordings.front());
  fast_edi::TopicNames topics = arguments.topics;
  topics.output = "/validate_bag";  // writes none: topics of deblurred frames may be there already
  {
    const fast_edi::TopicNames wanted = topics;
    topics = fast_edi::guessTopics(wanted, recording->connections());
    std::cout << fast_edi::guessText(wanted, topics, recording->connections());
    const std::string faults = fast_edi::checkTopics(topics, recording->connections());
    if (!faults.empty()) {
      fast_edi::printFinding(
          std::cout, {"topics", "event arrays, frames and exposures (std_msgs/Int32)", faults,
                      "name them by --events, --image and --exposure, or record them"});
      return kFindings;
    }
  }
  std::cout << "events " << topics.events << ", frames " << topics.image << ", exposures "
            << topics.exposure << "\n";
  fast_edi::RecordingValidator validator(start.parameters, start.pipeline);
  const tools::ReadResult pass =
      tools::readThrough(arguments.recordings, topics, "looking through", validator);
  fast_edi::ValidationReport report =
      tools::finishValidation(arguments.recordings, topics, validator);
  addFileFindings(pass, start.parameters.origin, report.findings);
  fast_edi::printReport(std::cout, validator.survey(), report);
  if (!arguments.output.empty()) {
    drawCurve(curvePath(arguments), report.timing);
  }
  return report.findings.empty() ? kDone : kFindings;
}

}  // namespace

int main(int argc, char** argv) {
  return tools::runTool("validate_bag", [argc, argv] {
    Arguments arguments;
    return parseArguments(argc, argv, arguments) ? run(arguments) : kDone;
  });
}
