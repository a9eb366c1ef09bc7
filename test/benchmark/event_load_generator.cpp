/// \file
/// A camera under load: publishes event arrays, images and exposures like the davis driver, at any
/// event rate, for a bounded time; prints what it sent as JSON.
///
/// It must not be what limits the receiver. Arrays are serialised once; for each publishing their
/// stamps are moved on in place, and roscpp sends the very same memory. An array can be used again
/// once roscpp has let go of it. When none is free the array at hand is skipped and counted, or,
/// with --unpaced, waited for: then events come as fast as the receiver takes them.

#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <limits>
#include <string>
#include <thread>
#include <vector>

#include <ros/ros.h>
#include <ros/topic_manager.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/image_encodings.h>
#include <std_msgs/Int32.h>
#include <boost/program_options.hpp>

#include "fast_edi/messages/event_array.hpp"
#include "support/event_generators.hpp"

namespace fast_edi::benchmarks {
namespace {

namespace po = boost::program_options;
using Clock = std::chrono::steady_clock;

constexpr std::int64_t kFirstStamp_ns = 1'000'000'000 * kNanosecondsPerSecond;
/// From the end of an exposure to its image.
constexpr std::int64_t kReadout_ns = 4 * kNanosecondsPerMillisecond;
/// Arrays on their way may reach back this far before one is skipped.
constexpr std::int64_t kPoolSpan_ns = 250 * kNanosecondsPerMillisecond;
/// The same when unpaced: images overtake events on their own connection, but must not do so by
/// more than the receiver waits for events.
constexpr std::int64_t kUnpacedPoolSpan_ns = 50 * kNanosecondsPerMillisecond;
constexpr std::size_t kSmallestPool = 3;
constexpr std::uint32_t kQueue = 1000;  // of images and exposures
constexpr std::chrono::microseconds kPollInterval{100};
constexpr std::chrono::seconds kConnectTimeout{30};
constexpr std::chrono::seconds kDrainTimeout{5};

struct Options {
  double rate_mev_s = 13.0;
  double array_ms = 10.0;
  double frames_hz = 30.0;
  double exposure_ms = 30.0;
  double seconds = 10.0;
  SensorSize size{346, 260};
  int queue = 1000;
  bool unpaced = false;
  bool hold = false;
};

/// An array as it goes over the wire, used again and again.
class SerialisedArray {
 public:
  SerialisedArray(const Options& options, std::size_t events, std::int64_t span_ns,
                  std::uint64_t seed)
      : start_ns_(kFirstStamp_ns), count_(events) {
    EventArray array;
    array.width = static_cast<std::uint32_t>(options.size.width);
    array.height = static_cast<std::uint32_t>(options.size.height);
    const std::vector<std::uint8_t> wire = testing::toWire(testing::makeEvents(
        testing::EventScene::kUniform, {options.size, events, start_ns_, span_ns, seed}));
    array.assign(testing::wireView(wire));
    message_ = ros::serialization::serializeMessage(array);
    records_ = message_.buf.get() + message_.num_bytes - events * kWireEventBytes;
  }

  /// roscpp holds no reference to the memory any more.
  bool isFree() const { return message_.buf.use_count() == 1; }
  std::size_t count() const { return count_; }

  void publish(const std::string& topic, std::int64_t start_ns) {
    testing::shiftStamps(start_ns - start_ns_, records_, count_);
    start_ns_ = start_ns;
    ros::SerializedMessage unused;
    ros::TopicManager::instance()->publish(
        topic, [this] { return message_; }, unused);
  }

 private:
  ros::SerializedMessage message_;
  std::uint8_t* records_ = nullptr;
  std::int64_t start_ns_;
  std::size_t count_;
};

struct Sent {
  std::uint64_t events = 0;
  std::uint64_t arrays = 0;
  std::uint64_t skipped_arrays = 0;
  std::uint64_t images = 0;
  double longest_lag_ms = 0.0;
};

class LoadGenerator {
 public:
  explicit LoadGenerator(const Options& options)
      : options_(options),
        array_ns_(static_cast<std::int64_t>(options.array_ms * kNanosecondsPerMillisecond)),
        exposure_ns_(static_cast<std::int64_t>(options.exposure_ms * kNanosecondsPerMillisecond)),
        events_publisher_(
            nh_.advertise<EventArray>("events", static_cast<std::uint32_t>(options.queue))),
        image_publisher_(nh_.advertise<sensor_msgs::Image>("image_raw", kQueue)),
        exposure_publisher_(nh_.advertise<std_msgs::Int32>("exposure", kQueue)) {
    // rate [1/us] * array [ns] / 1000
    const auto events = static_cast<std::size_t>(
        options.rate_mev_s * static_cast<double>(array_ns_) / kNanosecondsPerMicrosecond);
    const std::int64_t pool_ns = options.unpaced ? kUnpacedPoolSpan_ns : kPoolSpan_ns;
    const std::size_t pool = std::max(kSmallestPool, static_cast<std::size_t>(pool_ns / array_ns_));
    for (std::size_t i = 0; i < pool; ++i) pool_.emplace_back(options, events, array_ns_, i + 1);

    image_.width = static_cast<std::uint32_t>(options.size.width);
    image_.height = static_cast<std::uint32_t>(options.size.height);
    image_.step = image_.width;
    image_.encoding = sensor_msgs::image_encodings::MONO8;
    image_.data = testing::makeGreyImage(options.size, 1);
  }

  bool waitForSubscriber() const {
    const auto deadline = Clock::now() + kConnectTimeout;
    while (events_publisher_.getNumSubscribers() == 0 ||
           image_publisher_.getNumSubscribers() == 0 ||
           exposure_publisher_.getNumSubscribers() == 0) {
      if (Clock::now() > deadline || !ros::ok()) return false;
      std::this_thread::sleep_for(kPollInterval);
    }
    return true;
  }

  void run() {
    const auto begin = Clock::now();
    const auto end = begin + std::chrono::duration<double>(options_.seconds);
    std::int64_t next_array_ns = kFirstStamp_ns;  // start of the array
    std::int64_t next_frame_ns = kFirstStamp_ns;  // start of the exposure
    const auto frame_period_ns =
        static_cast<std::int64_t>(kNanosecondsPerSecond / options_.frames_hz);
    while (Clock::now() < end && ros::ok()) {
      const std::int64_t array_due_ns = next_array_ns + array_ns_;
      const std::int64_t image_due_ns = next_frame_ns + exposure_ns_ + kReadout_ns;
      const std::int64_t due_ns = std::min(array_due_ns, image_due_ns);
      if (!options_.unpaced) {
        const auto due = begin + std::chrono::nanoseconds(due_ns - kFirstStamp_ns);
        std::this_thread::sleep_until(due);
        const double lag_ms = std::chrono::duration<double, std::milli>(Clock::now() - due).count();
        sent_.longest_lag_ms = std::max(sent_.longest_lag_ms, lag_ms);
      }
      if (array_due_ns <= image_due_ns) {
        sendArray(next_array_ns);
        next_array_ns += array_ns_;
      } else {
        sendFrame(next_frame_ns);
        next_frame_ns += frame_period_ns;
      }
    }
    // The last frame gets all of its events.
    const std::int64_t last_end_ns = next_frame_ns - frame_period_ns + exposure_ns_;
    for (; next_array_ns <= last_end_ns && ros::ok(); next_array_ns += array_ns_) {
      if (!options_.unpaced) {
        std::this_thread::sleep_until(
            begin + std::chrono::nanoseconds(next_array_ns + array_ns_ - kFirstStamp_ns));
      }
      sendArray(next_array_ns);
    }
    drain();
    seconds_ = std::chrono::duration<double>(Clock::now() - begin).count();
  }

  void print() const {
    rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    const auto seconds = [](const timeval& time) {
      return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
    };
    std::printf(
        "{\"events\": %llu, \"arrays\": %llu, \"skipped_arrays\": %llu, \"images\": %llu, "
        "\"seconds\": %.3f, \"cpu_seconds\": %.3f, \"longest_lag_ms\": %.3f}\n",
        static_cast<unsigned long long>(sent_.events),
        static_cast<unsigned long long>(sent_.arrays),
        static_cast<unsigned long long>(sent_.skipped_arrays),
        static_cast<unsigned long long>(sent_.images), seconds_,
        seconds(usage.ru_utime) + seconds(usage.ru_stime), sent_.longest_lag_ms);
  }

 private:
  void sendArray(std::int64_t start_ns) {
    SerialisedArray& array = pool_[next_in_pool_];
    while (options_.unpaced && !array.isFree() && ros::ok()) {
      std::this_thread::sleep_for(kPollInterval);
    }
    if (!array.isFree()) {
      ++sent_.skipped_arrays;
      return;
    }
    array.publish(events_publisher_.getTopic(), start_ns);
    next_in_pool_ = (next_in_pool_ + 1) % pool_.size();
    sent_.events += array.count();
    ++sent_.arrays;
  }

  void sendFrame(std::int64_t start_ns) {
    image_.header.stamp.fromNSec(static_cast<std::uint64_t>(start_ns + exposure_ns_ / 2));
    image_publisher_.publish(image_);
    std_msgs::Int32 exposure;
    exposure.data = static_cast<std::int32_t>(exposure_ns_ / kNanosecondsPerMicrosecond);
    exposure_publisher_.publish(exposure);
    ++sent_.images;
  }

  /// Waits until all that was sent has left this process.
  void drain() const {
    const auto deadline = Clock::now() + kDrainTimeout;
    const auto isFree = [](const SerialisedArray& array) { return array.isFree(); };
    while (!std::all_of(pool_.begin(), pool_.end(), isFree) && Clock::now() < deadline) {
      std::this_thread::sleep_for(kPollInterval);
    }
  }

  Options options_;
  std::int64_t array_ns_;
  std::int64_t exposure_ns_;
  ros::NodeHandle nh_;
  ros::Publisher events_publisher_;
  ros::Publisher image_publisher_;
  ros::Publisher exposure_publisher_;
  std::vector<SerialisedArray> pool_;
  std::size_t next_in_pool_ = 0;
  sensor_msgs::Image image_;
  Sent sent_;
  double seconds_ = 0.0;
};

Options parse(int argc, char** argv) {
  Options options;
  po::options_description description(
      "Publishes events, image_raw and exposure in its namespace, then prints what it sent");
  description.add_options()("help,h", "print this")(
      "rate", po::value(&options.rate_mev_s)->default_value(options.rate_mev_s), "events [1/us]")(
      "array", po::value(&options.array_ms)->default_value(options.array_ms),
      "length of an event array [ms]")(
      "fps", po::value(&options.frames_hz)->default_value(options.frames_hz), "frames [Hz]")(
      "exposure", po::value(&options.exposure_ms)->default_value(options.exposure_ms),
      "exposure time [ms]")("seconds", po::value(&options.seconds)->default_value(options.seconds),
                            "how long to publish [s]")(
      "width", po::value(&options.size.width)->default_value(options.size.width), "[px]")(
      "height", po::value(&options.size.height)->default_value(options.size.height), "[px]")(
      "queue", po::value(&options.queue)->default_value(options.queue),
      "arrays that wait for the receiver; older ones are dropped as roscpp does")(
      "unpaced", po::bool_switch(&options.unpaced), "as fast as the receiver takes them")(
      "hold", po::bool_switch(&options.hold),
      "stay until the end of standard input: what a slow receiver has not taken yet would be lost");
  po::variables_map values;
  po::store(po::parse_command_line(argc, argv, description), values);
  po::notify(values);
  if (values.count("help") > 0) {
    std::cout << description;
    std::exit(EXIT_SUCCESS);
  }
  if (options.rate_mev_s <= 0.0 || options.array_ms <= 0.0 || options.frames_hz <= 0.0 ||
      options.exposure_ms <= 0.0 || options.queue <= 0) {
    throw std::invalid_argument("rate, array, fps, exposure and queue must be greater than 0");
  }
  return options;
}

}  // namespace
}  // namespace fast_edi::benchmarks

int main(int argc, char** argv) {
  ros::init(argc, argv, "event_load_generator");
  try {
    const fast_edi::benchmarks::Options options = fast_edi::benchmarks::parse(argc, argv);
    fast_edi::benchmarks::LoadGenerator generator(options);
    if (!generator.waitForSubscriber()) {
      std::cerr << "nobody subscribed to events, image_raw and exposure within 30 s\n";
      return EXIT_FAILURE;
    }
    generator.run();
    generator.print();
    if (options.hold) {
      std::fflush(stdout);
      std::cin.ignore(std::numeric_limits<std::streamsize>::max());
    }
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return EXIT_FAILURE;
  }
  return EXIT_SUCCESS;
}
