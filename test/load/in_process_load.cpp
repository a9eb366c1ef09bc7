/// \file
/// The class behind node and nodelet under 1, 3 and 10 times the events that it can take, in one
/// process with the camera, where every event and every frame is accounted for. Writes what
/// happened as JSON; test/load/run judges and draws it.

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <iostream>
#include <memory>
#include <mutex>
#include <sstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <ros/callback_queue.h>
#include <ros/init.h>
#include <ros/master.h>
#include <ros/param.h>
#include <ros/spinner.h>
#include <boost/program_options.hpp>

#include "load/load_camera.hpp"
#include "load/recovery.hpp"
#include "load/throttled_spinner.hpp"
#include "node/deblur_node.hpp"
#include "rostest/node_client.hpp"
#include "rostest/ros_master.hpp"

namespace fast_edi::load {
namespace {

namespace po = boost::program_options;

const std::string kNamespace = "/load";
const std::string kNode = "/load/deblur";
/// Of the arrays that find out what can be taken; small beside what one frame needs.
constexpr std::size_t kProbeEvents = 10'000;
constexpr std::chrono::milliseconds kSamplePeriod{50};

struct Options {
  double seconds = 10.0;
  double probe_seconds = 3.0;
  double share = 0.1;
  int max_events = 2'000'000;
  std::string out;
  std::vector<double> factors{1.0, 3.0, 10.0};
};

double residentMb() {
  std::ifstream statm("/proc/self/statm");
  double pages = 0;
  double resident = 0;
  statm >> pages >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1e6;
}

double secondsSince(Clock::time_point zero, Clock::time_point time) {
  return std::chrono::duration<double>(time - zero).count();
}

/// Memory of this process over time, as pairs of seconds and MB.
class MemoryLog {
 public:
  explicit MemoryLog(Clock::time_point zero) : thread_([this, zero] { run(zero); }) {}
  ~MemoryLog() { end(); }
  std::vector<std::pair<double, double>> end() {
    stop_ = true;
    if (thread_.joinable()) {
      thread_.join();
    }
    return samples_;
  }

 private:
  void run(Clock::time_point zero) {
    while (!stop_) {
      samples_.emplace_back(secondsSince(zero, Clock::now()), residentMb());
      std::this_thread::sleep_for(kSamplePeriod);
    }
  }

  std::atomic<bool> stop_{false};
  std::vector<std::pair<double, double>> samples_;
  std::thread thread_;
};

/// Output images as a consumer gets them.
class OutputLog {
 public:
  struct Entry {
    Clock::time_point arrival;
    std::int64_t stamp_ns;
  };

  OutputLog() {
    nh_.setCallbackQueue(&queue_);
    subscriber_ = nh_.subscribe<sensor_msgs::Image>(
        kNamespace + "/deblurred/image_raw", 1000, [this](const sensor_msgs::ImageConstPtr& image) {
          const std::lock_guard<std::mutex> lock(mutex_);
          entries_.push_back(
              {Clock::now(), static_cast<std::int64_t>(image->header.stamp.toNSec())});
        });
    spinner_.start();
  }
  ~OutputLog() {
    subscriber_.shutdown();
    spinner_.stop();
  }

  std::size_t size() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return entries_.size();
  }
  std::vector<Entry> since(std::size_t first) const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return {entries_.begin() + static_cast<std::ptrdiff_t>(first), entries_.end()};
  }

 private:
  mutable std::mutex mutex_;
  std::vector<Entry> entries_;
  ros::CallbackQueue queue_;
  ros::NodeHandle nh_;
  ros::AsyncSpinner spinner_{1, &queue_};
  ros::Subscriber subscriber_;
};

/// What the node says of itself.
struct Counts {
  explicit Counts(const diagnostic_msgs::DiagnosticStatus& report) {
    const auto value = [&report](const std::string& key) -> std::int64_t {
      const std::string text = test::valueOf(report, key);
      return text.empty() ? 0 : std::stoll(text);
    };
    events_in = value("Events in");
    events_overflowed = value("Events overflowed");
    events_dropped = value("Events late") + value("Events outside the sensor") +
                     value("Events glitched") + value("Events refused");
    gaps = value("Event array gaps");
    frames_in = value("Frames in");
    frames_out = value("Frames out");
    deblurred = value("Frames deblurred");
    waiting = value("Backlog: waiting frames");
    internal_errors = value("Internal errors");
  }

  std::int64_t events_in, events_overflowed, events_dropped, gaps;
  std::int64_t frames_in, frames_out, deblurred, waiting, internal_errors;
};

/// Writes pairs as JSON.
std::string json(const std::vector<std::pair<double, double>>& pairs) {
  std::ostringstream out;
  out << "[";
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    out << (i > 0 ? ", " : "") << "[" << pairs[i].first << ", " << pairs[i].second << "]";
  }
  out << "]";
  return out.str();
}

class LoadTest {
 public:
  explicit LoadTest(const Options& options) : options_(options) {
    ros::param::set(kNode + "/contrast_threshold_on", 0.3);
    ros::param::set(kNode + "/contrast_threshold_off", 0.25);
    ros::param::set(kNode + "/filter", false);
    ros::param::set(kNode + "/max_buffered_events", options.max_events);
    before_mb_ = residentMb();
    ros::NodeHandle nh(kNamespace);
    ros::NodeHandle private_nh(kNode);
    nh.setCallbackQueue(&queue_);
    private_nh.setCallbackQueue(&queue_);
    node_ = std::make_unique<DeblurNode>(nh, private_nh, kNode);
    if (!node_->configurationError().empty()) {
      throw std::runtime_error(node_->configurationError());
    }
    spinner_ = std::make_unique<ThrottledSpinner>(queue_, options.share);
    log_ = std::make_unique<OutputLog>();
    if (!test::waitUntil([this] { return camera_.hasSubscribers() && log_isConnected(); })) {
      throw std::runtime_error("the node does not listen");
    }
  }
  ~LoadTest() {
    log_.reset();
    spinner_.reset();
  }
  LoadTest(const LoadTest&) = delete;
  LoadTest& operator=(const LoadTest&) = delete;

  void run(std::ostream& out) {
    const LoadCamera::Sent probe = camera_.sendAsTaken(kProbeEvents, options_.probe_seconds);
    const double capacity = static_cast<double>(probe.events) / probe.seconds;
    const double bound_mb =
        (12.0 * options_.max_events + 48.0 * static_cast<double>(kSensor.pixelCount())) / 1e6 + 80;
    out << "{\"capacity_ev_s\": " << capacity << ", \"before_mb\": " << before_mb_
        << ", \"bound_mb\": " << bound_mb << ", \"share\": " << options_.share << ", \"levels\": [";
    settled(static_cast<std::int64_t>(probe.events), static_cast<std::int64_t>(probe.frames));
    for (std::size_t i = 0; i < options_.factors.size(); ++i) {
      out << (i > 0 ? ",\n" : "\n");
      level(options_.factors[i], capacity, atRest(), out);
    }
    out << "]}\n";
  }

 private:
  bool log_isConnected() const {
    return test::publisherSendsToUs(kNamespace + "/deblurred/image_raw");
  }

  /// The report once everything that was sent has been taken in and put out, or the last one.
  Counts settled(std::int64_t events, std::int64_t frames) {
    client_.waitForReport([&](const diagnostic_msgs::DiagnosticStatus& report) {
      const Counts now(report);
      return now.events_in >= events && now.frames_in >= frames && now.waiting == 0;
    });
    return Counts(client_.report());
  }

  /// The report when nothing comes in any more.
  Counts atRest() {
    std::int64_t before = -1;
    client_.waitForReport([&before](const diagnostic_msgs::DiagnosticStatus& report) {
      return std::exchange(before, Counts(report).events_in) == Counts(report).events_in;
    });
    return Counts(client_.report());
  }

  void level(double factor, double capacity, const Counts& before, std::ostream& out) {
    const std::size_t first_output = log_->size();
    const Clock::time_point zero = Clock::now();
    MemoryLog memory(zero);
    const LoadCamera::Sent sent = camera_.sendAtRate(factor * capacity, options_.seconds);
    const Counts after = settled(before.events_in + static_cast<std::int64_t>(sent.events),
                                 before.frames_in + static_cast<std::int64_t>(sent.frames));
    const auto outputs = log_->since(first_output);
    const std::string fault = faultAfterLoad(kNamespace, kNode);

    std::vector<std::pair<double, double>> latency_ms;
    double longest_silence_s = 0.0;
    double longest_gap_s = 0.0;
    bool stamps_increase = true;
    for (std::size_t i = 0; i < outputs.size(); ++i) {
      latency_ms.emplace_back(
          secondsSince(zero, outputs[i].arrival),
          1e3 * secondsSince(camera_.sentAt(outputs[i].stamp_ns), outputs[i].arrival));
      if (i > 0) {
        longest_silence_s =
            std::max(longest_silence_s, secondsSince(outputs[i - 1].arrival, outputs[i].arrival));
        longest_gap_s = std::max(
            longest_gap_s, static_cast<double>(outputs[i].stamp_ns - outputs[i - 1].stamp_ns) /
                               static_cast<double>(kNanosecondsPerSecond));
        stamps_increase = stamps_increase && outputs[i].stamp_ns > outputs[i - 1].stamp_ns;
      }
    }
    out << "{\"factor\": " << factor << ", \"seconds\": " << sent.seconds
        << ", \"events\": " << sent.events
        << ", \"events_in\": " << after.events_in - before.events_in
        << ", \"events_overflowed\": " << after.events_overflowed - before.events_overflowed
        << ", \"events_dropped\": " << after.events_dropped - before.events_dropped
        << ", \"gaps\": " << after.gaps - before.gaps << ", \"frames\": " << sent.frames
        << ", \"frames_in\": " << after.frames_in - before.frames_in
        << ", \"frames_out\": " << after.frames_out - before.frames_out
        << ", \"deblurred\": " << after.deblurred - before.deblurred << ", \"passed\": "
        << after.frames_out - before.frames_out - (after.deblurred - before.deblurred)
        << ", \"received\": " << outputs.size()
        << ", \"internal_errors\": " << after.internal_errors
        << ", \"longest_silence_s\": " << longest_silence_s
        << ", \"longest_gap_s\": " << longest_gap_s
        << ", \"stamps_increase\": " << (stamps_increase ? "true" : "false") << ", \"fault\": \""
        << fault << "\", \"memory_mb\": " << json(memory.end())
        << ", \"latency_ms\": " << json(latency_ms) << "}" << std::flush;
  }

  const Options options_;
  double before_mb_ = 0.0;
  ros::CallbackQueue queue_;
  LoadCamera camera_{kNamespace};
  test::NodeClient client_{kNamespace, kNode};
  std::unique_ptr<DeblurNode> node_;
  std::unique_ptr<ThrottledSpinner> spinner_;
  std::unique_ptr<OutputLog> log_;
};

Options parse(int argc, char** argv) {
  Options options;
  po::options_description description("Loads the class behind node and nodelet in this process");
  description.add_options()("help,h", "print this")("out", po::value(&options.out)->required(),
                                                    "file for what happened")(
      "seconds", po::value(&options.seconds)->default_value(options.seconds), "of each load [s]")(
      "probe-seconds", po::value(&options.probe_seconds)->default_value(options.probe_seconds),
      "of finding out what can be taken [s]")(
      "share", po::value(&options.share)->default_value(options.share),
      "of a processor that the class gets, 0..1")(
      "max-events", po::value(&options.max_events)->default_value(options.max_events),
      "max_buffered_events")(
      "factors",
      po::value(&options.factors)->multitoken()->default_value(options.factors, "1 3 10"),
      "loads, in units of what can be taken");
  po::variables_map values;
  po::store(po::parse_command_line(argc, argv, description), values);
  if (values.count("help") > 0) {
    std::cout << description;
    std::exit(EXIT_SUCCESS);
  }
  po::notify(values);
  if (options.seconds <= 0.0 || options.probe_seconds <= 0.0 || options.share <= 0.0 ||
      options.share > 1.0 || options.max_events < 1) {
    throw std::invalid_argument("seconds, share and max-events must be greater than 0, share <= 1");
  }
  return options;
}

}  // namespace
}  // namespace fast_edi::load

int main(int argc, char** argv) {
  using namespace fast_edi;
  try {
    const load::Options options = load::parse(argc, argv);
    const test::RosMaster master;
    ros::init(ros::M_string(), "load", ros::init_options::NoSigintHandler);
    if (!test::waitUntil([] { return ros::master::check(); })) {
      throw std::runtime_error("the ROS master does not answer");
    }
    ros::start();
    std::ofstream out(options.out);
    load::LoadTest(options).run(out);
    if (!out.flush()) {
      throw std::runtime_error("cannot write " + options.out);
    }
    ros::shutdown();
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return EXIT_FAILURE;
  }
  return EXIT_SUCCESS;
}
