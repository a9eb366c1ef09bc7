#include "validation_pass.hpp"

#include <memory>

#include <ros/serialization.h>
#include <sensor_msgs/Image.h>
#include <std_msgs/Int32.h>
#include <yaml-cpp/yaml.h>

#include "command_line.hpp"
#include "fast_edi/bags/bag_deserialise.hpp"
#include "fast_edi/bags/open_messages.hpp"
#include "fast_edi/config/parameters_from_yaml.hpp"
#include "fast_edi/messages/event_array.hpp"
#include "fast_edi/messages/message_conversion.hpp"
#include "progress_bar.hpp"

namespace fast_edi {
namespace tools {
namespace {

/// Hands a message on. \return false when it contradicts itself: it is not used
bool feed(const BagMessage& message, const TopicNames& topics, RecordingValidator& validator) {
  const auto record_ns = static_cast<std::int64_t>(message.time.toNSec());
  const std::string& topic = message.connection->topic;
  try {
    if (topic == topics.events) {
      const auto array = deserialise<EventArrayView>(message);
      validator.addEvents(array->events(), sensorSize(*array), array->header.seq, record_ns);
    } else if (topic == topics.exposure) {
      validator.addExposure(deserialise<std_msgs::Int32>(message)->data, record_ns);
    } else if (topic == topics.image) {
      const auto image = deserialise<sensor_msgs::Image>(message);
      const ImageReading reading = readImage(*image);
      if (reading.verdict == ImageVerdict::kMalformed) {
        return false;
      }
      FrameMessage frame;
      frame.stamp_ns = static_cast<std::int64_t>(image->header.stamp.toNSec());
      frame.sequence = image->header.seq;
      frame.record_ns = record_ns;
      frame.size = {static_cast<int>(image->width), static_cast<int>(image->height)};
      frame.pixels = reading.view;
      frame.fault = reading.reason;
      validator.addFrame(frame);
    }
  } catch (const ros::serialization::StreamOverrunException&) {
    return false;
  }
  return true;
}

}  // namespace

ValidationStart validationStart(const MessageSource& recording, const std::string& config,
                                std::vector<std::string> overrides) {
  AssumedParameters assumed;
  assumed.thresholds_given = true;
  if (config.empty() && !recording.biases()) {
    YAML::Node root(YAML::NodeType::Map);
    applyOverrides(root, overrides);
    if (!root["contrast_threshold_on"].IsDefined() && !root["biases"].IsDefined()) {
      assumed.thresholds_given = false;
      overrides.push_back("contrast_threshold_on:=" + std::to_string(assumed.thresholds.on));
      overrides.push_back("contrast_threshold_off:=" + std::to_string(assumed.thresholds.off));
    }
  }
  const LoadedParameters loaded = loadParametersFor(recording, config, overrides);
  printWarnings(loaded);
  assumed.thresholds = loaded.deblur.thresholds;
  assumed.stamp_reference = loaded.deblur.stamp_reference;
  assumed.time_offset_ns = loaded.deblur.time_offset_ns;
  assumed.exposure_time_ns = loaded.deblur.exposure_time_ns;
  assumed.exposure_from_parameter = loaded.deblur.exposure_source == ExposureSource::kParameter;
  return {assumed, loaded.deblur};
}

ReadResult readThrough(const std::vector<std::string>& recordings, const TopicNames& topics,
                       const std::string& label, RecordingValidator& validator) {
  ReadResult result;
  const std::unique_ptr<MessageSource> recording = openMessages(recordings);
  ProgressBar bar(label);
  BagMessage message;
  while (recording->next(message)) {
    result.malformed += feed(message, topics, validator) ? 0 : 1;
    bar.update(recording->position(), recording->length());
  }
  result.damage = recording->damage();
  return result;
}

ValidationReport finishValidation(const std::vector<std::string>& recordings,
                                  const TopicNames& topics, RecordingValidator& validator) {
  if (validator.endSurvey()) {
    readThrough(recordings, topics, "picking frames", validator);
  }
  ProgressBar bar("comparing frames with events");
  return validator.finish([&bar](int done, int total) {
    bar.update(static_cast<std::uint64_t>(done), static_cast<std::uint64_t>(total));
  });
}

}  // namespace tools
}  // namespace fast_edi
