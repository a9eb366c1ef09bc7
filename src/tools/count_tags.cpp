/// \file
/// `count_tags`: in how many frames of a recording an AprilTag is found, in the blurry frames, in
/// plain EDI's and in those of the package as it is configured.

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <sensor_msgs/Image.h>
#include <boost/program_options.hpp>

#include "command_line.hpp"
#include "fast_edi/bags/bag_deserialise.hpp"
#include "fast_edi/bags/bag_error.hpp"
#include "fast_edi/bags/bag_pipeline.hpp"
#include "fast_edi/bags/message_source.hpp"
#include "fast_edi/bags/open_messages.hpp"
#include "fast_edi/bags/topic_names.hpp"
#include "fast_edi/config/parameters_from_yaml.hpp"
#include "fast_edi/messages/image_pixels.hpp"
#include "fast_edi/messages/message_conversion.hpp"
#include "fast_edi/tags/tag_detector.hpp"
#include "progress_bar.hpp"

namespace {

namespace po = boost::program_options;
namespace tools = fast_edi::tools;
using fast_edi::BagPipeline;
using tools::kDone;
using tools::kInputIncomplete;

struct Arguments {
  std::vector<std::string> recordings;
  std::string config;
  std::string truth_topic = "/dvs/ground_truth/image_raw";
  fast_edi::TopicNames topics;
  fast_edi::TagDetectorSettings detector;
  std::vector<std::string> overrides;
};

/// What the detector finds in one kind of frames.
struct Count {
  std::uint64_t frames = 0;
  std::uint64_t frames_with_tags = 0;
  std::uint64_t tags = 0;
  std::map<std::int64_t, std::set<int>> ids;  ///< by stamp

  void add(const fast_edi::TagDetector& detector, const sensor_msgs::Image& image) {
    if (fast_edi::readImage(image).verdict != fast_edi::ImageVerdict::kSupported) {
      return;
    }
    const auto found = detector.detect(fast_edi::greyPixels(image));
    ++frames;
    frames_with_tags += found.empty() ? 0 : 1;
    tags += found.size();
    std::set<int>& here = ids[static_cast<std::int64_t>(image.header.stamp.toNSec())];
    for (const fast_edi::TagDetection& tag : found) {
      here.insert(tag.id);
    }
  }

  /// Ids that the true frame of the same stamp does not show.
  std::uint64_t falseTags(const Count& truth) const {
    std::uint64_t count = 0;
    for (const auto& [stamp_ns, here] : ids) {
      const auto shown = truth.ids.find(stamp_ns);
      if (shown == truth.ids.end()) {
        continue;
      }
      count += static_cast<std::uint64_t>(std::count_if(
          here.begin(), here.end(), [&](int id) { return shown->second.count(id) == 0; }));
    }
    return count;
  }
};

po::options_description describeOptions(Arguments& arguments) {
  po::options_description options("Options");
  options.add_options()("help,h", "print this")(
      "config", po::value(&arguments.config)->value_name("YAML"),
      "parameters, e.g. cfg/davis346.yaml; not needed when both contrast "
      "thresholds are given as name:=value")(
      "family", tools::textOption(arguments.detector.family, "NAME"), "family of the tags")(
      "decimate",
      po::value(&arguments.detector.decimate)
          ->default_value(arguments.detector.decimate)
          ->value_name("F"),
      "tags are searched in a frame smaller by this factor");
  tools::addTopicOptions(options, arguments.topics);
  options.add_options()("truth", tools::textOption(arguments.truth_topic, "TOPIC"),
                        "true sharp frames; may be missing");
  return options;
}

/// \return false when help was asked for and given
bool parseArguments(int argc, char** argv, Arguments& arguments) {
  const po::options_description visible = describeOptions(arguments);
  std::vector<std::string> words;
  auto values = tools::readCommandLine(
      argc, argv, visible,
      {"Usage: count_tags RECORDING... [options] [parameter:=value ...]\n\n"
       "Counts AprilTags in the frames of a recording: blurry, by plain EDI (filter:\n"
       "false), by this package as its parameters are, and in the true sharp frames\n"
       "where the recording has them. A tag is false when the true frame of its stamp\n"
       "does not show its id.\n",
       "0 done; 1 failed; 2 the recording was cut short or damaged."},
      &words);
  if (!values) {
    return false;
  }
  po::notify(*values);
  tools::requireRecordings(words, arguments.recordings, arguments.overrides);
  return true;
}

void printRow(const char* name, const Count& count, const Count& truth) {
  const double share = count.frames == 0 ? 0.0
                                         : 100.0 * static_cast<double>(count.frames_with_tags) /
                                               static_cast<double>(count.frames);
  std::printf("%-12s %8llu %18llu %8.1f %% %8llu", name,
              static_cast<unsigned long long>(count.frames),
              static_cast<unsigned long long>(count.frames_with_tags), share,
              static_cast<unsigned long long>(count.tags));
  if (truth.frames > 0) {
    std::printf(" %8llu", static_cast<unsigned long long>(count.falseTags(truth)));
  }
  std::printf("\n");
}

/// One recording through plain EDI and the package.
class TagCounter {
 public:
  TagCounter(const Arguments& arguments, const fast_edi::LoadedParameters& parameters)
      : truth_topic_(arguments.truth_topic),
        detector_(arguments.detector),
        plain_pipeline_(arguments.topics, withoutFilter(parameters)),
        ours_pipeline_(arguments.topics, parameters) {}

  /// \return false for a message that contradicts itself
  bool add(const fast_edi::BagMessage& message) {
    bool sound = plain_pipeline_.add(message);
    sound = ours_pipeline_.add(message) && sound;
    if (message.connection->topic == truth_topic_) {
      truth_.add(detector_, *fast_edi::deserialise<sensor_msgs::Image>(message));
    }
    takeOutputs();
    return sound;
  }

  void finish() {
    plain_pipeline_.finish();
    ours_pipeline_.finish();
    takeOutputs();
  }

  const fast_edi::DeblurCounters& counters() const { return ours_pipeline_.counters(); }

  void print() const {
    std::printf("%-12s %8s %18s %10s %8s%s\n", "", "frames", "frames with a tag", "", "tags",
                truth_.frames > 0 ? "    false" : "");
    printRow("blurry", blurry_, truth_);
    printRow("plain EDI", plain_, truth_);
    printRow("deblurred", ours_, truth_);
    if (truth_.frames > 0) {
      printRow("truth", truth_, truth_);
    }
  }

 private:
  static fast_edi::LoadedParameters withoutFilter(fast_edi::LoadedParameters parameters) {
    parameters.deblur.filter.enabled = false;
    return parameters;
  }

  void takeOutputs() {
    for (const BagPipeline::Output& output : plain_pipeline_.takeOutputs()) {
      plain_.add(detector_, *output.image);
    }
    for (const BagPipeline::Output& output : ours_pipeline_.takeOutputs()) {
      ours_.add(detector_, *output.image);
      // With the stamp of the output, so that it meets the truth.
      sensor_msgs::Image blurry = *fast_edi::messageFrame(output.frame.input).message;
      blurry.header.stamp = output.image->header.stamp;
      blurry_.add(detector_, blurry);
    }
  }

  std::string truth_topic_;
  fast_edi::TagDetector detector_;
  BagPipeline plain_pipeline_;
  BagPipeline ours_pipeline_;
  Count blurry_;
  Count plain_;
  Count ours_;
  Count truth_;
};

int run(const Arguments& arguments) {
  const std::unique_ptr<fast_edi::MessageSource> recording =
      fast_edi::openMessages(arguments.recordings);
  fast_edi::MessageSource& reader = *recording;
  const fast_edi::LoadedParameters parameters =
      tools::loadParametersFor(reader, arguments.config, arguments.overrides);
  tools::printWarnings(parameters);
  Arguments used = arguments;
  used.topics = tools::topicsIn(reader, arguments.topics, fast_edi::nameOf(arguments.recordings));
  TagCounter counter(used, parameters);
  std::uint64_t malformed = 0;
  {
    fast_edi::ProgressBar bar("counting");
    fast_edi::BagMessage message;
    while (reader.next(message)) {
      malformed += counter.add(message) ? 0 : 1;
      bar.update(reader.position(), reader.length());
    }
    counter.finish();
  }
  std::printf("%s, AprilTag %s, %llu frames deblurred of %llu\n",
              std::filesystem::path(arguments.recordings.front()).filename().c_str(),
              arguments.detector.family.c_str(),
              static_cast<unsigned long long>(counter.counters().frames_deblurred),
              static_cast<unsigned long long>(counter.counters().frames_in));
  counter.print();
  tools::printDamage(fast_edi::nameOf(arguments.recordings), reader.damage());
  tools::printMalformed(malformed);
  return reader.damage().empty() && malformed == 0 ? kDone : kInputIncomplete;
}

}  // namespace

int main(int argc, char** argv) {
  return tools::runTool("count_tags", [argc, argv] {
    Arguments arguments;
    return parseArguments(argc, argv, arguments) ? run(arguments) : kDone;
  });
}
