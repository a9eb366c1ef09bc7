/// \file
/// Small made-up recordings in the order in which a driver would publish them, and what the
/// pipeline makes of them when it is run without ROS.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <std_msgs/Int32.h>

#include "fast_edi/messages/event_array.hpp"
#include "fast_edi/parameters/parameters.hpp"
#include "fast_edi/pipeline/deblurrer.hpp"

namespace fast_edi {
namespace test {

/// One message; the others are null.
struct Arrival {
  std::int64_t time_ns = 0;  ///< in sensor time: when a driver would publish the message
  EventArray::ConstPtr events;
  sensor_msgs::ImageConstPtr image;
  sensor_msgs::CameraInfoConstPtr info;
  std_msgs::Int32ConstPtr exposure;
};

/// Everything in order of arrival.
using Recording = std::vector<Arrival>;

struct RecordingSettings {
  std::int64_t start_ns = 1'000 * kNanosecondsPerSecond;  ///< time of the first event
  int frames = 10;
  SensorSize size{64, 48};
  std::string encoding = "mono8";
  std::string frame_id = "camera";
  bool exposures = true;
  bool camera_info = true;
  std::int64_t first_exposure_ns = 60 * kNanosecondsPerMillisecond;  ///< after start_ns
  std::int64_t frame_period_ns = 40 * kNanosecondsPerMillisecond;
  std::int64_t exposure_ns = 10 * kNanosecondsPerMillisecond;
  std::int64_t array_period_ns = 33 * kNanosecondsPerMillisecond;
  std::int64_t event_period_ns = 20 * kNanosecondsPerMicrosecond;
  std::uint32_t seed = 1;
  std::uint32_t first_sequence = 0;  ///< of the event arrays
};

/// Random events at a steady rate, from start_ns until well after the last exposure; frames with
/// random pixels, stamped at the middle of their exposure and arriving after its end, each followed
/// by its exposure message.
Recording makeRecording(const RecordingSettings& settings);

/// Writes \p recording below the namespace \p ns, at its times of arrival.
void writeBag(const Recording& recording, const std::string& ns, const std::string& path);

std::vector<sensor_msgs::ImageConstPtr> imagesOf(const Recording& recording);

/// One output: image and camera_info.
struct Output {
  sensor_msgs::ImageConstPtr image;
  sensor_msgs::CameraInfoConstPtr info;
};

/// What the pipeline makes of \p recording.
std::vector<Output> deblurWithoutRos(const Recording& recording,
                                     const DeblurParameters& parameters);

/// The parameters of the nodes under test, see deblur_instance.launch.
DeblurParameters testParameters();

}  // namespace test
}  // namespace fast_edi
