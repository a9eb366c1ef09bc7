/// \file
/// `convert_recording`: a recording of any format as a bag, as AEDAT4 or HDF5, or its frames as
/// pictures.

#include <cstdint>
#include <filesystem>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include <boost/program_options.hpp>

#include "command_line.hpp"
#include "fast_edi/bags/bag_recording.hpp"
#include "fast_edi/bags/bag_writer.hpp"
#include "fast_edi/bags/message_source.hpp"
#include "fast_edi/bags/open_messages.hpp"
#include "fast_edi/bags/topic_names.hpp"
#include "fast_edi/pictures/open_pictures.hpp"
#include "fast_edi/recording/recording_error.hpp"
#include "film/frame_folder.hpp"
#include "interruption.hpp"
#include "progress_bar.hpp"
#include "recording_output.hpp"

namespace {

namespace fs = std::filesystem;
namespace po = boost::program_options;
namespace tools = fast_edi::tools;
using tools::kDone;
using tools::kInputIncomplete;
using tools::kInterrupted;

constexpr double kMaxArray_ms = 1000.0;

struct Arguments {
  std::vector<std::string> inputs;
  std::string output;
  std::string compression;  ///< empty: the usual one of the format
  double array_ms = 0.0;
  fast_edi::TopicNames topics;
  bool overwrite = false;
};

/// \return false when help was asked for and given
bool parseArguments(int argc, char** argv, Arguments& arguments) {
  po::options_description visible("Options");
  visible.add_options()("help,h", "print this")(
      "array-ms",
      po::value(&arguments.array_ms)->default_value(arguments.array_ms)->value_name("MS"),
      "length of a bag's event arrays, 0..1000; 0: as the recording has its packets")(
      "compression",
      po::value(&arguments.compression)->default_value("", "lz4, of HDF5 gzip")->value_name("KIND"),
      "none, lz4 (bag, AEDAT4), bz2 (bag), zstd (AEDAT4), gzip (HDF5)");
  tools::addForceOption(visible, arguments.overwrite);
  tools::addTopicOptions(visible, arguments.topics);
  const tools::HelpText text = {
      "Usage: convert_recording IN... OUT.bag   what davis_ros_driver would have recorded\n"
      "       convert_recording IN... OUT.aedat4 for iniVation's DV\n"
      "       convert_recording IN... OUT.h5     HDF5, as DSEC and event_utils have it\n"
      "       convert_recording IN... FOLDER     frames as PNG, and frames.csv with their times\n\n"
      "IN is any recording that the package reads, told by its content.\n"
      "Bags have /dvs/events, /dvs/image_raw stamped in the middle of the exposure, the\n"
      "exposure's length on /dvs/exposure behind each frame, and /dvs/imu.\n",
      "0 done; 1 failed, no output; 2 the input was cut short or damaged: all of it that could be\n"
      "read is in the output; 130, 143 interrupted by Ctrl-C or SIGTERM."};
  std::vector<std::string> words;
  auto values = tools::readCommandLine(argc, argv, visible, text, &words);
  if (!values) {
    return false;
  }
  po::notify(*values);
  if (words.size() < 2) {
    throw po::error("expected IN and OUT");
  }
  arguments.output = words.back();
  words.pop_back();
  arguments.inputs = words;
  if (!(arguments.array_ms >= 0.0 && arguments.array_ms <= kMaxArray_ms)) {
    throw po::error("--array-ms " + std::to_string(arguments.array_ms) + ": expected 0..1000");
  }
  return true;
}

std::string extensionOf(const std::string& path) {
  return fs::path(path).extension().string();
}

/// What was converted.
struct Counts {
  std::uint64_t events = 0;
  std::uint64_t frames = 0;
  std::uint64_t exposures = 0;
  std::uint64_t samples = 0;
  std::uint64_t left_out = 0;
  bool interrupted = false;
};

void count(const fast_edi::RecordingItem& item, Counts& counts) {
  if (const auto* events = std::get_if<fast_edi::RecordedEvents>(&item.content)) {
    counts.events += events->count;
  } else if (const auto* frame = std::get_if<fast_edi::RecordedFrame>(&item.content)) {
    ++counts.frames;
    counts.exposures += frame->exposure ? 1 : 0;
  } else if (std::holds_alternative<fast_edi::RecordedImu>(item.content)) {
    ++counts.samples;
  }
}

/// Any recording, item by item.
std::unique_ptr<fast_edi::Recording> openItems(const Arguments& arguments) {
  if (arguments.inputs.size() == 1) {
    if (std::unique_ptr<fast_edi::Recording> recording =
            fast_edi::openRecordingOrPictures(arguments.inputs.front())) {
      return recording;
    }
  }
  return std::make_unique<fast_edi::BagRecording>(arguments.inputs, arguments.topics);
}

template <typename Use>
Counts forEach(fast_edi::Recording& recording, Use use) {
  Counts counts;
  fast_edi::ProgressBar bar("converting");
  fast_edi::RecordingItem item;
  while (!(counts.interrupted = tools::interruptingSignal() != 0) && recording.next(item)) {
    count(item, counts);
    use(item);
    bar.update(recording.position(), recording.length());
  }
  return counts;
}

int finish(const Arguments& arguments, const Counts& counts,
           const std::vector<fast_edi::RecordingDamage>& damage) {
  std::cout << counts.events << " events, " << counts.frames << " frames, " << counts.exposures
            << " of them with their exposure, " << counts.samples << " IMU samples\n"
            << "written: " << arguments.output << "\n"
            << std::flush;
  if (counts.left_out > 0) {
    std::cerr << "warning: " << counts.left_out << " messages or frames were left out\n";
  }
  tools::printDamage(fast_edi::nameOf(arguments.inputs), damage);
  if (counts.interrupted) {
    std::cerr << "interrupted: the output is complete up to there\n";
    return kInterrupted + tools::interruptingSignal();
  }
  return damage.empty() && counts.left_out == 0 ? kDone : kInputIncomplete;
}

int toRecording(const Arguments& arguments) {
  try {
    tools::checkCompression(arguments.output, arguments.compression);
  } catch (const std::invalid_argument& error) {
    throw po::error(error.what());
  }
  const std::unique_ptr<fast_edi::Recording> recording = openItems(arguments);
  const std::unique_ptr<fast_edi::RecordingWriter> writer = tools::makeRecordingWriter(
      arguments.output, recording->streams(), arguments.compression, arguments.overwrite);
  Counts counts =
      forEach(*recording, [&](const fast_edi::RecordingItem& item) { writer->write(item); });
  writer->close();
  if (const auto* bag = dynamic_cast<const fast_edi::BagRecording*>(recording.get())) {
    counts.left_out += bag->malformed();
  }
  return finish(arguments, counts, recording->damage());
}

int toFolder(const Arguments& arguments) {
  const std::unique_ptr<fast_edi::Recording> recording = openItems(arguments);
  fast_edi::FrameFolder folder(arguments.output, arguments.overwrite);
  Counts counts = forEach(*recording, [&](const fast_edi::RecordingItem& item) {
    const auto* frame = std::get_if<fast_edi::RecordedFrame>(&item.content);
    if (frame == nullptr) {
      return;
    }
    sensor_msgs::Image image;
    image.header.stamp.fromNSec(static_cast<std::uint64_t>(frame->stamp_ns));
    image.width = static_cast<std::uint32_t>(frame->size.width);
    image.height = static_cast<std::uint32_t>(frame->size.height);
    image.encoding = frame->encoding;
    image.step = static_cast<std::uint32_t>(frame->bytes) / image.height;
    image.data.assign(frame->pixels, frame->pixels + frame->bytes);
    folder.add(image, frame->exposure);
  });
  folder.close();
  counts.left_out += folder.leftOut();
  return finish(arguments, counts, recording->damage());
}

int toBag(const Arguments& arguments) {
  const std::string compression = arguments.compression.empty() ? "lz4" : arguments.compression;
  if (!fast_edi::isKnownCompression(compression)) {
    throw po::error("--compression " + compression + ": expected none, lz4 or bz2 for a bag");
  }
  const auto array_ns = static_cast<std::int64_t>(
      arguments.array_ms * static_cast<double>(fast_edi::kNanosecondsPerMillisecond));
  const std::unique_ptr<fast_edi::MessageSource> source =
      fast_edi::openMessages(arguments.inputs, array_ns);
  fast_edi::BagWriter writer(arguments.output, arguments.inputs, compression, arguments.overwrite);
  std::uint64_t messages = 0;
  bool interrupted = false;
  {
    fast_edi::ProgressBar bar("converting");
    fast_edi::BagMessage message;
    while (!(interrupted = tools::interruptingSignal() != 0) && source->next(message)) {
      writer.copy(message);
      ++messages;
      bar.update(source->position(), source->length());
    }
  }
  writer.close();
  std::cout << messages << " messages\nwritten: " << arguments.output << "\n" << std::flush;
  tools::printDamage(fast_edi::nameOf(arguments.inputs), source->damage());
  if (interrupted) {
    std::cerr << "interrupted: the output is complete up to there\n";
    return kInterrupted + tools::interruptingSignal();
  }
  return source->damage().empty() ? kDone : kInputIncomplete;
}

int run(const Arguments& arguments) {
  tools::refuseInput(arguments.output, arguments.inputs);
  tools::refuseInput(arguments.output + ".active", arguments.inputs);  // the name it grows under
  const std::string extension = extensionOf(arguments.output);
  if (extension == ".bag") {
    return toBag(arguments);
  }
  if (tools::isRecordingOutput(arguments.output)) {
    return toRecording(arguments);
  }
  if (!extension.empty() && !fs::is_directory(arguments.output)) {
    throw po::error(arguments.output + ": expected OUT.bag, OUT.aedat4, OUT.h5 or a folder");
  }
  return toFolder(arguments);
}

}  // namespace

int main(int argc, char** argv) {
  tools::handleSignals();
  return tools::runTool("convert_recording", [argc, argv] {
    Arguments arguments;
    return parseArguments(argc, argv, arguments) ? run(arguments) : kDone;
  });
}
