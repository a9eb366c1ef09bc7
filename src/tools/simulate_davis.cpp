/// \file
/// Writes a bag as a DAVIS under davis_ros_driver would have recorded it, from the simulator, with
/// the true sharp frames beside the blurry ones.
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <iostream>
#include <limits>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <geometry_msgs/PoseStamped.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/distortion_models.h>
#include <sensor_msgs/image_encodings.h>
#include <std_msgs/Int32.h>
#include <boost/program_options.hpp>
#include <opencv2/imgproc.hpp>

#include "command_line.hpp"
#include "fast_edi/bags/bag_recording.hpp"
#include "fast_edi/bags/bag_writer.hpp"
#include "fast_edi/bags/topic_names.hpp"
#include "fast_edi/messages/event_array.hpp"
#include "recording_output.hpp"
#include "simulation/davis_simulator.hpp"
#include "simulation/recording_faults.hpp"
#include "simulation/sensor_models.hpp"

namespace {

using fast_edi::ColourFilter;
using fast_edi::DavisSimulator;
using fast_edi::Event;
using fast_edi::EventArray;
using fast_edi::ExposureInstant;
using fast_edi::kNanosecondsPerMicrosecond;
using fast_edi::kNanosecondsPerMillisecond;
using fast_edi::SensorSettings;
using fast_edi::SimulatedFrame;
using fast_edi::SimulatedInterval;
using fast_edi::SimulationSettings;
namespace encodings = sensor_msgs::image_encodings;
namespace po = boost::program_options;
namespace tools = fast_edi::tools;

/// When messages reach the recorder: a frame leaves the camera when its readout has ended, an event
/// array when USB has delivered its last packet.
constexpr std::int64_t kFrameReadoutNs = 5 * kNanosecondsPerMillisecond;
constexpr std::int64_t kExposureMessageDelayNs = 100 * kNanosecondsPerMicrosecond;
constexpr std::int64_t kArrayDelayNs = kNanosecondsPerMillisecond;
constexpr std::int64_t kImuDelayNs = kNanosecondsPerMillisecond;

constexpr const char* kWorldFrame = "world";
constexpr const char* kImuFrame = "imu";

/// How the recording is laid down in messages.
struct RecordingOptions {
  std::string path;
  std::string name_space = "/dvs";
  std::string encoding = encodings::MONO8;
  std::string compression = "none";
  ExposureInstant stamp = ExposureInstant::kMid;
  ExposureInstant truth = ExposureInstant::kMid;
  std::int64_t array_length_us = 10'000;
  bool overwrite = false;
  bool exposure_topic = true;
  bool camera_info_topic = true;
  bool ground_truth_topic = true;
  fast_edi::RecordingFaults faults;
};

ros::Time rosTime(std::int64_t t_ns) {
  ros::Time time;
  time.fromNSec(static_cast<std::uint64_t>(t_ns));
  return time;
}

geometry_msgs::PoseStamped makePose(const fast_edi::RigidPose& pose, std::int64_t stamp_ns) {
  geometry_msgs::PoseStamped message;
  message.header.stamp = rosTime(stamp_ns);
  message.header.frame_id = kWorldFrame;
  message.pose.position.x = pose.position.x();
  message.pose.position.y = pose.position.y();
  message.pose.position.z = pose.position.z();
  message.pose.orientation.x = pose.orientation.x();
  message.pose.orientation.y = pose.orientation.y();
  message.pose.orientation.z = pose.orientation.z();
  message.pose.orientation.w = pose.orientation.w();
  return message;
}

/// Without orientation, which such a sensor does not measure (REP 145).
sensor_msgs::Imu makeImu(const fast_edi::ImuSample& sample, const fast_edi::ImuSettings& settings) {
  sensor_msgs::Imu message;
  message.header.stamp = rosTime(sample.t_ns);
  message.header.frame_id = kImuFrame;
  message.orientation_covariance[0] = -1.0;
  message.angular_velocity.x = sample.angular_velocity.x();
  message.angular_velocity.y = sample.angular_velocity.y();
  message.angular_velocity.z = sample.angular_velocity.z();
  message.linear_acceleration.x = sample.linear_acceleration.x();
  message.linear_acceleration.y = sample.linear_acceleration.y();
  message.linear_acceleration.z = sample.linear_acceleration.z();
  constexpr std::size_t kDiagonal = 4;
  for (std::size_t i = 0; i < message.angular_velocity_covariance.size(); i += kDiagonal) {
    message.angular_velocity_covariance[i] =
        settings.rate_hz * settings.gyroscope_noise * settings.gyroscope_noise;
    message.linear_acceleration_covariance[i] =
        settings.rate_hz * settings.accelerometer_noise * settings.accelerometer_noise;
  }
  return message;
}

/// Lays a simulation down in messages, in the order of their record times.
class Recording {
 public:
  Recording(const RecordingOptions& options, const DavisSimulator& simulator)
      : options_(options),
        simulator_(simulator),
        writer_(options.path, {}, options.compression, options.overwrite),
        timing_(simulator.settings().timing),
        faulty_(options.faults, simulator.settings().sensor.size, timing_),
        array_end_ns_(timing_.start_ns) {
    const SimulationSettings& settings = simulator.settings();
    const fast_edi::SensorSize stated = faulty_.eventSize(settings.sensor.size);
    array_.width = static_cast<std::uint32_t>(stated.width);
    array_.height = static_cast<std::uint32_t>(stated.height);
    camera_info_ = makeCameraInfo(settings);
    imu_settings_ = settings.imu;
    array_end_ns_ += options_.array_length_us * kNanosecondsPerMicrosecond;
  }

  void add(const SimulatedInterval& interval) {
    addFrame(interval.frame);
    for (const fast_edi::ImuSample& sample : interval.imu) {
      enqueue("/imu", sample.t_ns + kImuDelayNs, makeImu(sample, imu_settings_));
    }
    std::vector<Event> events = interval.events;
    faulty_.apply(interval.frame.exposure, events);
    for (Event& event : events) {
      if (event.t_ns >= array_end_ns_) closeArraysUntil(event.t_ns);
      event.t_ns = faulty_.eventStamp(event.t_ns);
      if (events_in_array_ == 0) array_.header.stamp = rosTime(event.t_ns);
      array_.append(event);
      ++events_in_array_;
    }
    // Later messages come later: events of the next interval lie in the open array or after it, and
    // its frame is recorded after its exposure.
    writeUntil(std::min(array_end_ns_, interval.end_ns));
  }

  void close(std::int64_t end_ns) {
    closeArraysUntil(end_ns);
    closeArray();
    writeUntil(std::numeric_limits<std::int64_t>::max());
    writer_.close();
  }

 private:
  static sensor_msgs::CameraInfo makeCameraInfo(const SimulationSettings& settings) {
    // Like the driver's: no stamp, no frame_id.
    sensor_msgs::CameraInfo info;
    info.width = static_cast<std::uint32_t>(settings.sensor.size.width);
    info.height = static_cast<std::uint32_t>(settings.sensor.size.height);
    info.distortion_model = sensor_msgs::distortion_models::PLUMB_BOB;
    info.D.assign(5, 0.0);
    const double f = settings.focalLengthPx();
    const double cx = 0.5 * (settings.sensor.size.width - 1);
    const double cy = 0.5 * (settings.sensor.size.height - 1);
    info.K = {f, 0.0, cx, 0.0, f, cy, 0.0, 0.0, 1.0};
    info.R = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
    info.P = {f, 0.0, cx, 0.0, 0.0, f, cy, 0.0, 0.0, 0.0, 1.0, 0.0};
    return info;
  }

  sensor_msgs::Image makeImage(const cv::Mat& raw, std::int64_t stamp_ns) const {
    cv::Mat pixels = raw;
    // OpenCV names a pattern by the second row's second and third pixel: its BG is RGGB.
    if (options_.encoding == encodings::RGB8) {
      cv::cvtColor(raw, pixels, cv::COLOR_BayerBG2RGB);
    } else if (options_.encoding == encodings::BGR8) {
      cv::cvtColor(raw, pixels, cv::COLOR_BayerBG2BGR);
    }
    if (options_.faults.more_rows > 0 && inSecondHalf()) {
      cv::copyMakeBorder(pixels, pixels, 0, static_cast<int>(options_.faults.more_rows), 0, 0,
                         cv::BORDER_REPLICATE);
    }
    sensor_msgs::Image image;
    image.header.seq = frames_;
    image.header.stamp = rosTime(stamp_ns);
    image.width = static_cast<std::uint32_t>(pixels.cols);
    image.height = static_cast<std::uint32_t>(pixels.rows);
    image.encoding =
        options_.faults.unknown_encoding != 0 ? encodings::TYPE_32FC1 : options_.encoding;
    image.is_bigendian = 0;
    image.step = static_cast<std::uint32_t>(pixels.cols * pixels.elemSize());
    // Freshly made matrices are without padding.
    image.data.assign(pixels.datastart, pixels.dataend);
    return image;
  }

  bool inSecondHalf() const { return static_cast<int>(frames_) >= timing_.frames / 2; }
  /// How many messages since the middle of the recording are to be lost.
  bool isLost(std::int64_t lost, std::int64_t since_middle) const {
    return since_middle >= 0 && since_middle < lost;
  }

  void addFrame(const SimulatedFrame& frame) {
    const std::int64_t time_ns = frame.exposure.end_ns + kFrameReadoutNs;
    const bool repeats =
        options_.faults.repeated_stamp != 0 && static_cast<int>(frames_) == timing_.frames / 2;
    if (!repeats) frame_stamp_ns_ = faulty_.frameStamp(frame.exposure.at(options_.stamp));
    const std::int64_t since_middle = static_cast<std::int64_t>(frames_) - timing_.frames / 2;
    if (!isLost(options_.faults.dropped_images, since_middle)) {
      enqueue("/image_raw", time_ns, makeImage(frame.blurry, frame_stamp_ns_));
    }
    if (options_.ground_truth_topic) {
      const std::int64_t truth_ns = frame.exposure.at(options_.truth);
      const cv::Mat truth =
          options_.truth == ExposureInstant::kMid ? frame.sharp : simulator_.latentAt(truth_ns);
      enqueue("/ground_truth/image_raw", time_ns, makeImage(truth, faulty_.frameStamp(truth_ns)));
      if (frame.pose) {
        const std::int64_t middle_ns = frame.exposure.at(ExposureInstant::kMid);
        enqueue("/ground_truth/pose", time_ns, makePose(*frame.pose, middle_ns));
      }
    }
    addExposure(frame, time_ns + kExposureMessageDelayNs);
    ++frames_;
  }

  void addExposure(const SimulatedFrame& frame, std::int64_t time_ns) {
    const fast_edi::RecordingFaults& faults = options_.faults;
    const bool lost = faults.dropped_exposures > 0 && frames_ % faults.dropped_exposures == 1;
    if (!options_.exposure_topic || lost) return;
    std::int64_t exposure_us = frame.exposure.length() / kNanosecondsPerMicrosecond;
    if (faults.exposure_of_next != 0) {
      exposure_us = timing_.exposureUs(static_cast<int>(frames_) + 1);
    }
    if (faults.exposure_percent > 0) exposure_us = exposure_us * faults.exposure_percent / 100;
    std_msgs::Int32 exposure;
    exposure.data = static_cast<std::int32_t>(exposure_us);
    enqueue("/exposure", time_ns, exposure);
  }

  /// A scene without events gives no arrays.
  void closeArray() {
    if (events_in_array_ == 0) return;
    array_.header.seq = arrays_++;
    if (array_end_ns_ > faulty_.middle() && lost_arrays_ < options_.faults.dropped_arrays) {
      ++lost_arrays_;
    } else {
      enqueue("/events", array_end_ns_ + kArrayDelayNs, array_);
    }
    if (options_.camera_info_topic) {
      enqueue("/camera_info", array_end_ns_ + kArrayDelayNs, camera_info_);
    }
    array_.clear();
    events_in_array_ = 0;
  }

  void closeArraysUntil(std::int64_t t_ns) {
    const std::int64_t length_ns = options_.array_length_us * kNanosecondsPerMicrosecond;
    while (array_end_ns_ <= t_ns) {
      closeArray();
      array_end_ns_ += length_ns;
    }
  }

  template <typename Message>
  void enqueue(const std::string& topic, std::int64_t time_ns, const Message& message) {
    waiting_.emplace(time_ns, [this, topic, time_ns, message] {
      writer_.write(options_.name_space + topic, rosTime(time_ns), message);
    });
  }

  void writeUntil(std::int64_t time_ns) {
    const auto end = waiting_.upper_bound(time_ns);
    for (auto it = waiting_.begin(); it != end; ++it) it->second();
    waiting_.erase(waiting_.begin(), end);
  }

  RecordingOptions options_;
  const DavisSimulator& simulator_;
  fast_edi::BagWriter writer_;
  sensor_msgs::CameraInfo camera_info_;
  fast_edi::ImuSettings imu_settings_;
  EventArray array_;
  fast_edi::TimingSettings timing_;
  fast_edi::FaultyStream faulty_;
  std::int64_t array_end_ns_;
  std::int64_t frame_stamp_ns_ = 0;  ///< of the last frame
  std::int64_t lost_arrays_ = 0;
  std::uint64_t events_in_array_ = 0;
  std::uint32_t arrays_ = 0;
  std::uint32_t frames_ = 0;
  std::multimap<std::int64_t, std::function<void()>> waiting_;  ///< by record time
};

SensorSettings sensorFromModel(const std::string& name) {
  try {
    return fast_edi::sensorModel(name);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(std::string("--noise: ") + error.what());
  }
}

std::string namesOfSensorModels() {
  std::string names;
  for (const std::string& name : fast_edi::sensorModelNames()) {
    names += (names.empty() ? "" : ", ") + name;
  }
  return names;
}

/// Dim light makes up for a long exposure. Whole settings, in the place of the plane's defaults.
void applyRoomPreset(SimulationSettings& settings) {
  settings.kind = fast_edi::SceneKind::kRoom;
  settings.max_step_px = 1.0;
  settings.max_step_us = 2000;
  settings.scene.density = 0.9;
  settings.scene.illumination = 0.3;
  settings.sensor.white_dn /= settings.scene.illumination;
  settings.timing.frames = 1200;
  settings.timing.period_us = 50'000;
  settings.timing.exposure_us = 40'000;
  settings.timing.lead_us = 100'000;
}

void applySensorName(const std::string& name, SensorSettings& sensor) {
  if (name == "davis346") {
    sensor.size = fast_edi::kDavis346Size;
  } else if (name == "davis240c") {
    sensor.size = fast_edi::kDavis240cSize;
  } else {
    throw std::invalid_argument("--sensor: expected davis346 or davis240c, got \"" + name + "\"");
  }
}

void applyEncoding(const std::string& encoding, SensorSettings& sensor) {
  if (encoding == encodings::MONO16) {
    sensor.frame_bits = 16;
  } else if (encoding == encodings::BAYER_RGGB8 || encoding == encodings::RGB8 ||
             encoding == encodings::BGR8) {
    sensor.colour_filter = ColourFilter::kBayerRggb;
  } else if (encoding != encodings::MONO8) {
    throw std::invalid_argument(
        "--encoding: expected mono8, mono16, bayer_rggb8, rgb8 or bgr8, got \"" + encoding + "\"");
  }
}

ExposureInstant instantFromName(const std::string& option, const std::string& name) {
  if (name == "start") return ExposureInstant::kStart;
  if (name == "mid") return ExposureInstant::kMid;
  if (name == "end") return ExposureInstant::kEnd;
  throw std::invalid_argument(option + ": expected start, mid or end, got \"" + name + "\"");
}

/// An option that overwrites \p target when given; the help shows the value it has now.
template <typename Value>
void addOption(po::options_description& group, const char* name, Value& target,
               const std::string& description) {
  std::ostringstream text;
  text << description << " (default " << target << ")";
  group.add_options()(name,
                      po::value<Value>()->value_name("X")->notifier(
                          [&target](const Value& value) { target = value; }),
                      text.str().c_str());
}

std::string describeFaults() {
  std::ostringstream text;
  text << "a fault to plant, may be repeated; X changes its strength. One of:";
  for (const fast_edi::FaultDescription& fault : fast_edi::faultDescriptions()) {
    text << "\n" << fault.name << "=" << fault.usual << ": " << fault.meaning;
  }
  return text.str();
}

/// One line on the terminal, redrawn.
void showProgress(int done, int total, std::uint64_t events) {
  constexpr int kWidth = 30;
  const int filled = total > 0 ? kWidth * done / total : kWidth;
  std::fprintf(stderr, "\r[%s%s] frame %d of %d, %.1f million events",
               std::string(static_cast<std::size_t>(filled), '#').c_str(),
               std::string(static_cast<std::size_t>(kWidth - filled), '.').c_str(), done, total,
               static_cast<double>(events) * 1e-6);
  if (done == total) std::fputc('\n', stderr);
}

/// Events, frames with their exposures and, in AEDAT4, IMU samples of a bag; there is no place for
/// the rest.
void writeRecording(const std::string& bag, const RecordingOptions& options) {
  fast_edi::TopicNames topics;
  topics.events = options.name_space + "/events";
  topics.image = options.name_space + "/image_raw";
  topics.exposure = options.name_space + "/exposure";
  fast_edi::BagRecording recording({bag}, topics);
  const auto writer = tools::makeRecordingWriter(options.path, recording.streams(),
                                                 options.compression, options.overwrite);
  fast_edi::RecordingItem item;
  while (recording.next(item)) {
    writer->write(item);
  }
  writer->close();
}

void simulate(const SimulationSettings& settings, const RecordingOptions& options) {
  DavisSimulator simulator(settings);
  RecordingOptions bag = options;
  if (tools::isRecordingOutput(options.path)) {
    tools::checkCompression(options.path, options.compression);  // throws before the work is done
    if (options.stamp != ExposureInstant::kMid) {
      throw std::invalid_argument(
          "--stamp: AEDAT4 and HDF5 have start and end of the exposure, expected mid");
    }
    tools::requireFree(options.path, options.overwrite);
    bag.path += ".bag";  // for the time being
    bag.compression = "none";
  }
  Recording recording(bag, simulator);
  const bool terminal = isatty(STDERR_FILENO) != 0;
  std::uint64_t events = 0;
  std::size_t tags = 0;
  int frames = 0;
  SimulatedInterval interval;
  while (simulator.next(interval)) {
    events += interval.events.size();
    tags += interval.frame.visible_tags.size();
    recording.add(interval);
    ++frames;
    if (terminal) showProgress(frames, settings.timing.frames, events);
  }
  recording.close(interval.end_ns);
  if (tools::isRecordingOutput(options.path)) {
    writeRecording(bag.path, options);
    std::filesystem::remove(bag.path);
  }
  const double seconds = static_cast<double>(interval.end_ns - settings.timing.start_ns) /
                         static_cast<double>(fast_edi::kNanosecondsPerSecond);
  std::printf("%s: %d frames, %llu events in %.2f s (%.2f million/s), %zu tags in view\n",
              options.path.c_str(), frames, static_cast<unsigned long long>(events), seconds,
              static_cast<double>(events) / seconds * 1e-6, tags);
}

int run(int argc, char** argv) {
  SimulationSettings settings;
  RecordingOptions options;
  std::string scene_name = "plane";
  std::string sensor = "davis346";
  std::string noise = "typical";
  std::string texture = "poster";
  std::string hot_shape = "single";
  std::string motion = "shake";
  std::string stamp = "mid";
  std::string truth = "mid";
  double duration_s = 0.0;

  po::options_description output("Recording");
  output.add_options()("help,h", "print this text");
  output.add_options()("out,o", po::value<std::string>()->value_name("PATH"),
                       "bag to write, or AEDAT4 (.aedat4) or HDF5 (.h5) without the true frames");
  bool overwrite_by_old_name = false;
  tools::addForceOption(output, options.overwrite);
  output.add_options()("overwrite", po::bool_switch(&overwrite_by_old_name), "old name of --force");
  addOption(output, "compression", options.compression,
            "none, bz2 or lz4; of AEDAT4 none, lz4 or zstd");
  addOption(output, "namespace", options.name_space, "namespace of all topics");
  addOption(output, "encoding", options.encoding, "mono8, mono16, bayer_rggb8, rgb8 or bgr8");
  addOption(output, "stamp", stamp,
            "instant of the exposure that an image's stamp means: mid (davis_ros_driver), start "
            "(dv-ros) or end");
  addOption(output, "truth", truth,
            "instant of the exposure that the true frames show and are stamped with: start, mid or "
            "end; true poses are those of mid");
  addOption(output, "array-us", options.array_length_us, "length of an event array [us]");
  output.add_options()("no-exposure", "leave out the exposure topic");
  output.add_options()("no-camera-info", "leave out the camera_info topic");
  output.add_options()("no-ground-truth", "leave out the true sharp frames");

  po::options_description scene("Scene");
  addOption(scene, "scene", scene_name,
            "plane, or room: with IMU and true poses; presets --density 0.9 --illumination 0.3 "
            "--white-dn 717 --frames 1200 --period-us 50000 --exposure-us 40000 --lead-us 100000");
  addOption(scene, "seed", settings.seed, "equal seeds give equal bags");
  addOption(scene, "texture", texture,
            "poster, natural, flat, mosaic, page, clouds, facade, weave, or a picture: anything "
            "with a '.' or '/' in it is a path");
  addOption(scene, "contrast", settings.scene.contrast,
            "of the texture, in the log around mid grey, 0..2");
  addOption(scene, "lamps", settings.scene.lamps,
            "bright discs in view, 0..20; with --flicker-hz they flicker as all light does");
  addOption(scene, "lamp-radiance", settings.scene.lamp_radiance,
            "of a lamp, in units of a white surface at illumination 1; above 1.2 it saturates");
  addOption(scene, "lamp-radius-px", settings.scene.lamp_radius_px, "of a lamp [px]");
  addOption(scene, "density", settings.scene.density, "how full the poster is, 0..1");
  addOption(scene, "tags", settings.scene.tags, "number of AprilTags (36h11)");
  addOption(scene, "tag-side-px", settings.scene.tag_side_px, "side of a tag's black square [px]");
  addOption(scene, "optics-sigma-px", settings.scene.optics_sigma_px, "blur of the lens [px]");
  addOption(scene, "illumination", settings.scene.illumination,
            "light on the scene, relative; scales DN and all that depends on brightness");
  addOption(scene, "flicker-hz", settings.scene.flicker_hz, "modulation of the light [Hz]");
  addOption(scene, "flicker-depth", settings.scene.flicker_depth, "its amplitude, relative, 0..1");
  addOption(scene, "motion", motion, "still, mild, pan, spin or shake");
  addOption(scene, "motion-scale", settings.motion.scale, "factor on all amplitudes and speeds");
  addOption(scene, "focal-length-px", settings.motion.focal_length_px,
            "focal length [px], 0 = 0.95 x width (room: 0.7 x width)");

  po::options_description timing("Timing");
  addOption(timing, "frames", settings.timing.frames, "number of frames");
  addOption(timing, "duration", duration_s, "frames for so long, instead of --frames [s]");
  addOption(timing, "period-us", settings.timing.period_us, "from frame to frame [us]");
  addOption(timing, "exposure-us", settings.timing.exposure_us, "exposure time [us]");
  addOption(timing, "exposure-swing", settings.timing.exposure_swing,
            "exposure times go up and down by this part, as with automatic exposure, 0..0.9");
  addOption(timing, "lead-us", settings.timing.lead_us,
            "events before the first exposure and after the last period [us]");
  addOption(timing, "start-ns", settings.timing.start_ns, "sensor time at the start [ns]");

  po::options_description room("Room");
  addOption(room, "room-length", settings.room.length_m, "along x [m]");
  addOption(room, "room-width", settings.room.width_m, "along y [m]");
  addOption(room, "room-height", settings.room.height_m, "[m]");
  addOption(room, "texel-m", settings.room.texel_m, "finest structure of the textures [m]");
  addOption(room, "lap-s", settings.room.lap_s,
            "about the time of a lap; whole laps are made, none in less than half of it [s]");
  addOption(room, "gentle-s", settings.room.gentle_s, "without shaking, at each end [s]");
  addOption(room, "shake-deg", settings.room.shake_rms_deg, "shaking, rms about each axis [deg]");
  addOption(room, "shake-hz", settings.room.shake_hz, "its mean frequency [Hz]");
  addOption(room, "wander", settings.room.wander, "factor on the walking about");
  addOption(room, "imu-rate", settings.imu.rate_hz, "[Hz]");
  addOption(room, "accelerometer-noise", settings.imu.accelerometer_noise, "[m/s^2/sqrt(Hz)]");
  addOption(room, "gyroscope-noise", settings.imu.gyroscope_noise, "[rad/s/sqrt(Hz)]");
  addOption(room, "accelerometer-walk", settings.imu.accelerometer_walk,
            "of the bias [m/s^3/sqrt(Hz)]");
  addOption(room, "gyroscope-walk", settings.imu.gyroscope_walk, "of the bias [rad/s^2/sqrt(Hz)]");
  addOption(room, "accelerometer-bias", settings.imu.accelerometer_bias,
            "standard deviation of its first value [m/s^2]");
  addOption(room, "gyroscope-bias", settings.imu.gyroscope_bias,
            "standard deviation of its first value [rad/s]");

  po::options_description pixels("Sensor");
  addOption(pixels, "sensor", sensor, "davis346 (346 x 260) or davis240c (240 x 180)");
  addOption(pixels, "width", settings.sensor.size.width, "other width [px]");
  addOption(pixels, "height", settings.sensor.size.height, "other height [px]");
  addOption(pixels, "noise", noise,
            "model of the sensor, one of " + namesOfSensorModels() +
                "; the options below change it, their defaults are those of typical");
  addOption(pixels, "threshold-on", settings.sensor.thresholds.on, "mean [natural log]");
  addOption(pixels, "threshold-off", settings.sensor.thresholds.off, "mean [natural log], > 0");
  addOption(pixels, "mismatch", settings.sensor.threshold_mismatch,
            "standard deviation of thresholds, relative to their mean");
  addOption(pixels, "refractory-ns", settings.sensor.refractory_ns, "refractory period [ns]");
  addOption(pixels, "clock-us", settings.sensor.clock_us,
            "event times are multiples of this [us]; coarser ones compress better");
  addOption(pixels, "leak-hz", settings.sensor.leak_rate_hz, "leak events [1/s per pixel]");
  addOption(pixels, "shot-noise-bright-hz", settings.sensor.shot_noise_bright_hz,
            "noise events of a white surface [1/s per pixel]");
  addOption(pixels, "shot-noise-dark-hz", settings.sensor.shot_noise_dark_hz,
            "noise events of a black surface [1/s per pixel]");
  addOption(pixels, "photoreceptor-bright-hz", settings.sensor.photoreceptor_bright_hz,
            "cut-off at a white surface [Hz], 0 = unlimited");
  addOption(pixels, "photoreceptor-dark-hz", settings.sensor.photoreceptor_dark_hz,
            "cut-off at a black surface [Hz], 0 = unlimited");
  addOption(pixels, "linear-below-dn", settings.sensor.linear_below_dn,
            "the pixel's log becomes linear below this, as in v2e (20 there), 0 or 2..250 [DN]");
  addOption(pixels, "delay-us", settings.sensor.delay_us,
            "event times are late by this, 0..20000 [us]");
  addOption(pixels, "hot-pixels", settings.sensor.hot_pixel_fraction,
            "pixels that fire all the time, fraction");
  addOption(pixels, "hot-pixel-shape", hot_shape,
            "how they lie together: single, pair, block (2x2), row (1x4) or column");
  addOption(pixels, "hot-pixel-hz", settings.sensor.hot_pixel_rate_hz, "at this rate [1/s]");
  addOption(pixels, "white-dn", settings.sensor.white_dn, "frames: white surface [DN]");
  addOption(pixels, "read-noise-dn", settings.sensor.read_noise_dn, "frames: read noise [DN rms]");
  addOption(pixels, "electrons-per-dn", settings.sensor.electrons_per_dn,
            "frames: shot noise, 0 = none");

  po::options_description faults("Faults, for trying out validate_bag");
  faults.add_options()("fault", po::value<std::vector<std::string>>()->value_name("NAME[=X]"),
                       describeFaults().c_str());

  po::options_description all;
  all.add(output).add(scene).add(timing).add(room).add(pixels).add(faults);
  auto given = tools::readCommandLine(
      argc, argv, all,
      {"Usage: simulate_davis --out PATH [options]\n\n"
       "Simulates a DAVIS moving over a textured plane and writes events, blurry frames, exposure\n"
       "times and true sharp frames as davis_ros_driver would have recorded "
       "them.\nIn a room also IMU readings and true poses: world with z up, camera and IMU at one "
       "place in\nthe optical frame (x right, y down, z forward), with the same pose at the start "
       "and the end.\n",
       "0 done; 1 failed, no output."},
      nullptr);
  if (!given) {
    return tools::kDone;
  }
  po::variables_map& values = *given;
  // Presets first, so that single options can change them.
  if (values.count("noise") != 0) noise = values["noise"].as<std::string>();
  if (values.count("sensor") != 0) sensor = values["sensor"].as<std::string>();
  settings.sensor = sensorFromModel(noise);
  applySensorName(sensor, settings.sensor);
  if (values.count("scene") != 0) scene_name = values["scene"].as<std::string>();
  if (fast_edi::sceneKindFromName(scene_name) == fast_edi::SceneKind::kRoom) {
    applyRoomPreset(settings);
  }
  po::notify(values);
  if (values.count("duration") != 0) {
    if (values.count("frames") != 0) {
      throw std::invalid_argument("--duration: expected without --frames");
    }
    constexpr double kLongestS = 1e5;
    if (!(duration_s > 0.0 && duration_s <= kLongestS)) {
      throw std::invalid_argument("--duration: expected more than 0 and at most 100000 s, got " +
                                  std::to_string(duration_s));
    }
    settings.timing.frames = static_cast<int>(
        std::lround(duration_s * 1e6 / static_cast<double>(settings.timing.period_us)));
  }
  applyEncoding(options.encoding, settings.sensor);
  options.stamp = instantFromName("--stamp", stamp);
  options.truth = instantFromName("--truth", truth);
  if (values.count("fault") != 0) {
    for (const std::string& fault : values["fault"].as<std::vector<std::string>>()) {
      fast_edi::plantFault(fault, options.faults);
    }
  }
  options.overwrite = options.overwrite || overwrite_by_old_name;
  options.exposure_topic = values.count("no-exposure") == 0;
  options.camera_info_topic = values.count("no-camera-info") == 0;
  options.ground_truth_topic = values.count("no-ground-truth") == 0;
  if (texture.find_first_of("./") != std::string::npos) {
    settings.scene.texture_file = texture;
  } else {
    settings.scene.texture = fast_edi::textureKindFromName(texture);
  }
  settings.sensor.hot_pixel_shape = fast_edi::hotPixelShapeFromName(hot_shape);
  settings.motion.kind = fast_edi::motionKindFromName(motion);
  if (options.array_length_us <= 0) {
    throw std::invalid_argument("--array-us: expected more than 0, got " +
                                std::to_string(options.array_length_us));
  }
  if (values.count("out") == 0) throw std::invalid_argument("--out: expected the bag to write");
  options.path = values["out"].as<std::string>();
  simulate(settings, options);
  return tools::kDone;
}

}  // namespace

int main(int argc, char** argv) {
  return tools::runTool("simulate_davis", [argc, argv] {
    try {
      return run(argc, argv);
    } catch (const std::invalid_argument& error) {  // a setting out of its range
      throw po::error(error.what());
    }
  });
}
