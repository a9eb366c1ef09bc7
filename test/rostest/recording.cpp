#include "rostest/recording.hpp"

#include <algorithm>
#include <random>
#include <utility>

#include <rosbag/bag.h>
#include <boost/make_shared.hpp>

#include "fast_edi/messages/message_frame_sink.hpp"

namespace fast_edi {
namespace test {
namespace {

/// From the end of the exposure until the driver publishes the frame.
constexpr std::int64_t kReadout_ns = 5 * kNanosecondsPerMillisecond;

std::uint32_t bytesPerPixelOf(const std::string& encoding) {
  return encoding == "mono16" ? 2 : encoding == "rgb8" || encoding == "bgr8" ? 3 : 1;
}

ros::Time toTime(std::int64_t t_ns) {
  ros::Time time;
  time.fromNSec(static_cast<std::uint64_t>(t_ns));
  return time;
}

sensor_msgs::ImageConstPtr makeImage(const RecordingSettings& settings, int index,
                                     std::int64_t stamp_ns, std::mt19937& random) {
  auto image = boost::make_shared<sensor_msgs::Image>();
  image->header.seq = static_cast<std::uint32_t>(index);
  image->header.stamp = toTime(stamp_ns);
  image->header.frame_id = settings.frame_id;
  image->encoding = settings.encoding;
  image->width = static_cast<std::uint32_t>(settings.size.width);
  image->height = static_cast<std::uint32_t>(settings.size.height);
  image->step = image->width * bytesPerPixelOf(settings.encoding);
  image->data.resize(std::size_t{image->step} * image->height);
  // Far from saturation, so that every event changes its pixel.
  std::uniform_int_distribution<int> dn(60, 120);
  for (std::uint8_t& byte : image->data) {
    byte = static_cast<std::uint8_t>(dn(random));
  }
  return image;
}

void addEvents(const RecordingSettings& settings, std::int64_t end_ns, std::mt19937& random,
               Recording& recording) {
  std::uniform_int_distribution<int> x(0, settings.size.width - 1);
  std::uniform_int_distribution<int> y(0, settings.size.height - 1);
  std::bernoulli_distribution on(0.5);
  std::int64_t t_ns = settings.start_ns;
  std::uint32_t seq = settings.first_sequence;
  while (t_ns < end_ns) {
    auto array = boost::make_shared<EventArray>();
    const std::int64_t array_end_ns = t_ns + settings.array_period_ns;
    array->header.seq = seq++;
    array->header.stamp = toTime(t_ns);
    array->width = static_cast<std::uint32_t>(settings.size.width);
    array->height = static_cast<std::uint32_t>(settings.size.height);
    for (; t_ns < array_end_ns; t_ns += settings.event_period_ns) {
      Event event;
      event.x = static_cast<std::uint16_t>(x(random));
      event.y = static_cast<std::uint16_t>(y(random));
      event.t_ns = t_ns;
      event.on = on(random);
      array->append(event);
    }
    recording.push_back({array_end_ns, array, nullptr, nullptr, nullptr});
  }
}

void addCameraInfo(const RecordingSettings& settings, Recording& recording) {
  auto info = boost::make_shared<sensor_msgs::CameraInfo>();
  info->width = static_cast<std::uint32_t>(settings.size.width);
  info->height = static_cast<std::uint32_t>(settings.size.height);
  info->distortion_model = "plumb_bob";
  info->K[0] = 250.0;
  info->K[4] = 251.0;
  info->K[8] = 1.0;
  recording.push_back({settings.start_ns, nullptr, nullptr, info, nullptr});
}

}  // namespace

Recording makeRecording(const RecordingSettings& settings) {
  std::mt19937 random(settings.seed);
  Recording recording;
  if (settings.camera_info) {
    addCameraInfo(settings, recording);
  }
  const std::int64_t first_start_ns = settings.start_ns + settings.first_exposure_ns;
  for (int i = 0; i < settings.frames; ++i) {
    const std::int64_t start_ns = first_start_ns + i * settings.frame_period_ns;
    const ExposureInterval exposure{start_ns, start_ns + settings.exposure_ns};
    const std::int64_t arrival_ns = exposure.end_ns + kReadout_ns;
    recording.push_back({arrival_ns, nullptr,
                         makeImage(settings, i, exposure.at(ExposureInstant::kMid), random),
                         nullptr, nullptr});
    if (settings.exposures) {
      auto length = boost::make_shared<std_msgs::Int32>();
      length->data = static_cast<std::int32_t>(settings.exposure_ns / kNanosecondsPerMicrosecond);
      recording.push_back({arrival_ns, nullptr, nullptr, nullptr, length});
    }
  }
  addEvents(settings, first_start_ns + settings.frames * settings.frame_period_ns, random,
            recording);
  std::stable_sort(recording.begin(), recording.end(),
                   [](const Arrival& a, const Arrival& b) { return a.time_ns < b.time_ns; });
  return recording;
}

void writeBag(const Recording& recording, const std::string& ns, const std::string& path) {
  rosbag::Bag bag(path, rosbag::bagmode::Write);
  for (const Arrival& arrival : recording) {
    const ros::Time time = toTime(arrival.time_ns);
    if (arrival.events) {
      bag.write(ns + "/events", time, *arrival.events);
    } else if (arrival.image) {
      bag.write(ns + "/image_raw", time, *arrival.image);
    } else if (arrival.info) {
      bag.write(ns + "/camera_info", time, *arrival.info);
    } else {
      bag.write(ns + "/exposure", time, *arrival.exposure);
    }
  }
}

std::vector<sensor_msgs::ImageConstPtr> imagesOf(const Recording& recording) {
  std::vector<sensor_msgs::ImageConstPtr> images;
  for (const Arrival& arrival : recording) {
    if (arrival.image) {
      images.push_back(arrival.image);
    }
  }
  return images;
}

std::vector<Output> deblurWithoutRos(const Recording& recording,
                                     const DeblurParameters& parameters) {
  std::vector<Output> outputs;
  MessageFrameSink sink("", [&outputs](const sensor_msgs::ImagePtr& image,
                                       const sensor_msgs::CameraInfoPtr& info, const OutputFrame&) {
    outputs.push_back({image, info});
  });
  Deblurrer deblurrer(parameters, sink);
  for (const Arrival& arrival : recording) {
    const std::int64_t now_ns = arrival.time_ns;
    if (arrival.events) {
      const EventArray& array = *arrival.events;
      deblurrer.addEvents(array.events(), sensorSize(array), array.header.seq, now_ns);
    } else if (arrival.image) {
      deblurrer.addFrame(makeInputFrame(arrival.image, readImage(*arrival.image), now_ns), now_ns);
    } else if (arrival.info) {
      sink.setCameraInfo(arrival.info);
    } else {
      deblurrer.addExposure(arrival.exposure->data, now_ns);
    }
  }
  deblurrer.finish();
  return outputs;
}

DeblurParameters testParameters() {
  DeblurParameters parameters;
  parameters.thresholds = {0.3, 0.25};
  return parameters;
}

}  // namespace test
}  // namespace fast_edi
