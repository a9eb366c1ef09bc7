#include "tools/evaluate/evaluate_recording.hpp"

#include <cstdint>
#include <filesystem>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <ros/serialization.h>
#include <sensor_msgs/Image.h>
#include <std_msgs/Int32.h>

#include "bags/recorded_frames.hpp"
#include "command_line.hpp"
#include "evaluation/evaluation.hpp"
#include "evaluation/frames_by_stamp.hpp"
#include "evaluation/report.hpp"
#include "fast_edi/bags/bag_deserialise.hpp"
#include "fast_edi/bags/bag_error.hpp"
#include "fast_edi/bags/message_source.hpp"
#include "fast_edi/bags/open_messages.hpp"
#include "fast_edi/bags/topic_names.hpp"
#include "fast_edi/messages/event_array.hpp"
#include "fast_edi/messages/message_conversion.hpp"
#include "progress_bar.hpp"
#include "tools/evaluate/evaluate_methods.hpp"
#include "tools/evaluate/evaluate_text.hpp"

namespace fast_edi::evaluate {
namespace {

/// \return false for a message that contradicts itself
bool feed(const BagMessage& message, const TopicNames& topics, MethodComparison& comparison) {
  const auto now_ns = static_cast<std::int64_t>(message.time.toNSec());
  const std::string& topic = message.connection->topic;
  comparison.advance(now_ns);
  try {
    if (topic == topics.events) {
      const auto array = deserialise<EventArrayView>(message);
      comparison.addEvents(array->events(), sensorSize(*array), array->header.seq, now_ns);
    } else if (topic == topics.image) {
      const auto image = deserialise<sensor_msgs::Image>(message);
      if (readImage(*image).verdict == ImageVerdict::kMalformed) {
        return false;
      }
      comparison.addFrame(static_cast<std::int64_t>(image->header.stamp.toNSec()), toMono8(*image),
                          now_ns);
    } else if (topic == topics.exposure) {
      comparison.addExposure(deserialise<std_msgs::Int32>(message)->data, now_ns);
    }
  } catch (const ros::serialization::StreamOverrunException&) {
    return false;
  }
  return true;
}

}  // namespace

int evaluateRecording(const Arguments& arguments) {
  const std::unique_ptr<MessageSource> recording = openMessages(arguments.recordings);
  MessageSource& reader = *recording;
  const LoadedParameters loaded =
      tools::loadParametersFor(reader, arguments.config, arguments.overrides);
  tools::printWarnings(loaded);
  std::vector<std::string> incomplete;
  const OtherMethods others = otherMethods(arguments, incomplete);
  prepareReportFolder(arguments.output, arguments.overwrite);
  const DeblurParameters& parameters = loaded.deblur;
  const TopicNames topics = tools::topicsIn(reader, arguments.topics, nameOf(arguments.recordings));
  const RecordedFrames truth = readFrames(arguments.recordings, arguments.truth_topic);
  const FrameScorer scorer(arguments.scorer);
  int without_truth = 0;
  EvaluationRecorder recorder(
      std::filesystem::path(arguments.recordings.front()).filename().string(), scorer,
      [&truth, &without_truth](std::int64_t stamp_ns) {
        const auto found = frameAt(truth.by_stamp, stamp_ns);
        without_truth += found == truth.by_stamp.end() ? 1 : 0;
        return found != truth.by_stamp.end() ? found->second : cv::Mat();
      },
      others);
  MethodComparison comparison(parameters, arguments.search,
                              [&recorder](const ComparedFrame& frame) { recorder.add(frame); });
  std::uint64_t malformed = truth.malformed;
  {
    ProgressBar bar("evaluating");
    BagMessage message;
    while (reader.next(message)) {
      malformed += feed(message, topics, comparison) ? 0 : 1;
      bar.update(reader.position(), reader.length());
    }
    comparison.finish();
  }

  const Evaluation& evaluation = recorder.evaluation();
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
  for (const std::unique_ptr<OtherMethod>& other : others) {
    const std::vector<std::string> more = other->notes();
    notes.insert(notes.end(), more.begin(), more.end());
  }
  notes.insert(notes.end(), incomplete.begin(), incomplete.end());
  if (evaluation.frames.empty()) {
    throw std::runtime_error(nameOf(arguments.recordings) + ": no frame could be deblurred" +
                             (evaluation.left_out.empty()
                                  ? std::string()
                                  : " (" + evaluation.left_out.begin()->first + ")"));
  }
  const std::vector<EvaluationGroup> groups = {{evaluation.name, {&evaluation}}};
  printGroups(groups, notes);
  std::cout << "written: "
            << writeReport(arguments.output,
                           {"Evaluation of " + evaluation.name, arguments.command, notes}, groups)
            << "\n";
  tools::printDamage(nameOf(arguments.recordings), reader.damage());
  tools::printMalformed(malformed);
  return reader.damage().empty() && malformed == 0 && incomplete.empty() ? tools::kDone
                                                                         : tools::kInputIncomplete;
}

}  // namespace fast_edi::evaluate
