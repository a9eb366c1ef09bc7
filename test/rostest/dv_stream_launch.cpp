// dv_stream.launch (nodelets in one manager), and both nodes in processes of their own, against a
// server of this package's tests: all of a recording arrives, and the deblurred frames are those of
// the same recording without a network. Starts roslaunch itself. The vendor's own server is in
// test/peers.

#include <algorithm>
#include <atomic>
#include <csignal>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include <diagnostic_msgs/DiagnosticArray.h>
#include <gtest/gtest.h>
#include <ros/ros.h>
#include <ros/spinner.h>

#include "rostest/child_process.hpp"
#include "rostest/expectations.hpp"
#include "rostest/node_client.hpp"
#include "rostest/recording.hpp"
#include "rostest/ros_process.hpp"
#include "stream/served_stream.hpp"
#include "stream/stream_server.hpp"

namespace fast_edi {
namespace test {
namespace {

using testing::ServedStream;
using testing::StreamBytes;
using testing::StreamPeer;
using testing::StreamServer;

constexpr std::size_t kCuts = 10;
constexpr char kLaunchFile[] = FAST_EDI_SOURCE_DIR "/launch/dv_stream.launch";
constexpr char kConfig[] = "config:=" FAST_EDI_SOURCE_DIR "/test/rostest/long_timeout.yaml";
constexpr char kStreamNode[] = FAST_EDI_TOOLS_DIR "/dv_stream_node";
constexpr char kDeblurNode[] = FAST_EDI_TOOLS_DIR "/deblur_node";

/// A recording whose cameras are served, with nothing that DV's streams do not have.
RecordingSettings servedSettings(std::int64_t start_s) {
  RecordingSettings settings;
  settings.start_ns = start_s * kNanosecondsPerSecond;
  settings.camera_info = false;
  settings.frames = 20;
  return settings;
}

std::vector<Event> eventsOf(const EventArray& array) {
  std::vector<Event> events;
  for (std::size_t i = 0; i < array.events().count; ++i) {
    events.push_back(decodeWireEvent(array.events().record(i)));
  }
  return events;
}

ServedStream serveEvents(const Recording& recording, const RecordingSettings& settings) {
  StreamBytes bytes({StreamKind::kEvents, "events", "DAVIS", settings.size},
                    Aedat4Compression::kLz4);
  for (const Arrival& arrival : recording) {
    if (arrival.events) {
      bytes.add(eventsOf(*arrival.events));
    }
  }
  return bytes.take();
}

ServedStream serveFrames(const Recording& recording, const RecordingSettings& settings) {
  StreamBytes bytes({StreamKind::kFrames, "frames", "DAVIS", settings.size},
                    Aedat4Compression::kNone);
  for (const sensor_msgs::ImageConstPtr& image : imagesOf(recording)) {
    RecordedFrame frame;
    frame.stamp_ns = static_cast<std::int64_t>(image->header.stamp.toNSec());
    frame.exposure = ExposureInterval{frame.stamp_ns - settings.exposure_ns / 2,
                                      frame.stamp_ns + settings.exposure_ns / 2};
    frame.size = settings.size;
    frame.encoding = image->encoding;
    frame.pixels = image->data.data();
    frame.bytes = image->data.size();
    bytes.add(frame);
  }
  return bytes.take();
}

/// Sends a first recording once it is told to, and a second one over eleven connections: each but
/// the last one ends in the middle of a packet, with which the next one begins.
class CuttingServer {
 public:
  CuttingServer(ServedStream whole, ServedStream in_parts)
      : whole_(std::move(whole)),
        in_parts_(std::move(in_parts)),
        server_([this](StreamPeer& peer) { serve(peer); }) {}

  std::string port() const { return std::to_string(server_.endpoint().port); }
  void sendWhole() { whole_wanted_ = true; }
  void sendInParts() { parts_wanted_ = true; }

 private:
  void serve(StreamPeer& peer) {
    peer.send(whole_.header);
    const auto number = static_cast<std::size_t>(peer.number());
    if (number == 0) {
      waitFor(peer, whole_wanted_);
      for (const std::string& packet : whole_.packets) {
        peer.send(packet);
      }
      waitFor(peer, parts_wanted_);
    }
    const std::size_t count = in_parts_.packets.size();
    const std::size_t end = count * (number + 1) / (kCuts + 1);
    for (std::size_t i = count * number / (kCuts + 1); i < end; ++i) {
      peer.send(in_parts_.packets[i]);
    }
    if (number < kCuts) {
      peer.send(in_parts_.packets[end].substr(0, in_parts_.packets[end].size() / 2));
    } else {
      peer.waitForEnd();
    }
  }

  static void waitFor(StreamPeer& peer, const std::atomic<bool>& wanted) {
    while (!wanted && peer.pause(std::chrono::milliseconds(2))) {
    }
  }

  const ServedStream whole_;
  const ServedStream in_parts_;
  std::atomic<bool> whole_wanted_{false};
  std::atomic<bool> parts_wanted_{false};
  StreamServer server_;
};

/// Everything that is published, each topic for itself.
class Listener {
 public:
  explicit Listener(const std::string& ns) : nh_(ns) {
    keep("events", events_);
    keep("image_raw", images_);
    keep("exposure", exposures_);
    keep("deblurred/image_raw", deblurred_);
    keep("deblurred/camera_info", infos_);
    subscribers_.push_back(nh_.subscribe<diagnostic_msgs::DiagnosticArray>(
        "/diagnostics", 100, [this](const diagnostic_msgs::DiagnosticArrayConstPtr& array) {
          const std::lock_guard<std::mutex> lock(mutex_);
          for (const diagnostic_msgs::DiagnosticStatus& status : array->status) {
            reports_[status.name] = status;
          }
        }));
    spinner_.start();
  }
  ~Listener() { spinner_.stop(); }
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;

  /// The newest report of a task, e.g. "dvs/deblur: deblurring".
  diagnostic_msgs::DiagnosticStatus report(const std::string& name) {
    const std::lock_guard<std::mutex> lock(mutex_);
    for (const auto& [task, status] : reports_) {
      if (task.find(name) != std::string::npos) {
        return status;
      }
    }
    return {};
  }
  std::vector<Event> events() {
    const std::lock_guard<std::mutex> lock(mutex_);
    std::vector<Event> all;
    for (const auto& array : events_) {
      const std::vector<Event> some = eventsOf(*array);
      all.insert(all.end(), some.begin(), some.end());
    }
    return all;
  }
  std::vector<sensor_msgs::ImageConstPtr> images() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return images_;
  }
  std::vector<int> exposures() {
    const std::lock_guard<std::mutex> lock(mutex_);
    std::vector<int> all;
    for (const auto& exposure : exposures_) {
      all.push_back(exposure->data);
    }
    return all;
  }
  std::vector<Output> outputs() {
    const std::lock_guard<std::mutex> lock(mutex_);
    std::vector<Output> all;
    for (std::size_t i = 0; i < std::min(deblurred_.size(), infos_.size()); ++i) {
      all.push_back({deblurred_[i], infos_[i]});
    }
    return all;
  }

 private:
  template <typename Message>
  void keep(const char* topic, std::vector<boost::shared_ptr<const Message>>& messages) {
    subscribers_.push_back(nh_.subscribe<Message>(
        topic, 1000,
        boost::function<void(const boost::shared_ptr<const Message>&)>(
            [this, &messages](const boost::shared_ptr<const Message>& message) {
              const std::lock_guard<std::mutex> lock(mutex_);
              messages.push_back(message);
            })));
  }

  std::mutex mutex_;
  std::vector<EventArray::ConstPtr> events_;
  std::vector<sensor_msgs::ImageConstPtr> images_;
  std::vector<std_msgs::Int32ConstPtr> exposures_;
  std::vector<sensor_msgs::ImageConstPtr> deblurred_;
  std::vector<sensor_msgs::CameraInfoConstPtr> infos_;
  std::map<std::string, diagnostic_msgs::DiagnosticStatus> reports_;
  ros::NodeHandle nh_;
  std::vector<ros::Subscriber> subscribers_;
  ros::AsyncSpinner spinner_{1};
};

/// Expects all events of \p recordings, one after the other.
void expectEvents(const std::vector<Recording>& recordings, Listener& listener) {
  std::vector<Event> expected;
  for (const Recording& recording : recordings) {
    for (const Arrival& arrival : recording) {
      if (arrival.events) {
        const std::vector<Event> some = eventsOf(*arrival.events);
        expected.insert(expected.end(), some.begin(), some.end());
      }
    }
  }
  EXPECT_TRUE(waitUntil([&] { return listener.events().size() >= expected.size(); }));
  const std::vector<Event> received = listener.events();
  ASSERT_EQ(received.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    ASSERT_EQ(received[i].t_ns, expected[i].t_ns) << "event " << i;
    ASSERT_EQ(received[i].x, expected[i].x) << "event " << i;
    ASSERT_EQ(received[i].y, expected[i].y) << "event " << i;
    ASSERT_EQ(received[i].on, expected[i].on) << "event " << i;
  }
}

using Processes = std::vector<std::unique_ptr<ChildProcess>>;

/// As `roslaunch fast_edi dv_stream.launch` does: both nodelets in one manager.
Processes launchNodelets(const std::string& ns, const std::string& events_port,
                         const std::string& frames_port) {
  Processes processes;
  processes.push_back(std::make_unique<ChildProcess>(std::vector<std::string>{
      "roslaunch", kLaunchFile, "namespace:=" + ns, "events_port:=" + events_port,
      "frames_port:=" + frames_port, "frame_id:=camera", "stall_timeout_s:=60", kConfig}));
  return processes;
}

Processes startNodes(const std::string& ns, const std::string& events_port,
                     const std::string& frames_port) {
  Processes processes;
  processes.push_back(std::make_unique<ChildProcess>(std::vector<std::string>{
      kStreamNode, "__ns:=" + ns, "__name:=dv_stream", "_events_port:=" + events_port,
      "_frames_port:=" + frames_port, "_frame_id:=camera", "_stall_timeout_s:=60"}));
  processes.push_back(std::make_unique<ChildProcess>(std::vector<std::string>{
      kDeblurNode, "__ns:=" + ns, "__name:=deblur", "_close_timeout_ms:=20000",
      "_contrast_threshold_on:=0.3", "_contrast_threshold_off:=0.25"}));
  return processes;
}

struct Way {
  const char* ns;
  Processes (*start)(const std::string&, const std::string&, const std::string&);
};

class DvStream : public ::testing::TestWithParam<Way> {};

TEST_P(DvStream, DeliversAndComesBack) {
  requireRos();
  const RecordingSettings settings = servedSettings(1000);
  const RecordingSettings later = servedSettings(1100);
  const Recording recording = makeRecording(settings);
  const Recording cut = makeRecording(later);
  CuttingServer events(serveEvents(recording, settings), serveEvents(cut, later));
  CuttingServer frames(serveFrames(recording, settings), serveFrames(cut, later));
  const std::string ns = GetParam().ns;
  Listener listener("/" + ns);
  Processes processes = GetParam().start(ns, events.port(), frames.port());
  for (const char* topic :
       {"events", "image_raw", "exposure", "deblurred/image_raw", "deblurred/camera_info"}) {
    ASSERT_TRUE(waitUntil([&] { return publisherSendsToUs("/" + ns + "/" + topic); })) << topic;
  }
  ASSERT_TRUE(waitUntil([&] {
    const diagnostic_msgs::DiagnosticStatus status = listener.report(ns + "/deblur:");
    return !status.message.empty() && status.message.find("idle") == std::string::npos;
  })) << "nothing is deblurred";

  events.sendWhole();
  frames.sendWhole();
  const std::size_t count = imagesOf(recording).size();
  EXPECT_TRUE(waitUntil([&] {
    return listener.outputs().size() >= count && listener.exposures().size() >= count;
  })) << listener.outputs().size();
  expectEvents({recording}, listener);
  const std::vector<sensor_msgs::ImageConstPtr> images = listener.images();
  ASSERT_EQ(images.size(), count);
  for (std::size_t i = 0; i < count; ++i) {
    EXPECT_EQ(images[i]->header.stamp, imagesOf(recording)[i]->header.stamp);
    EXPECT_EQ(images[i]->data, imagesOf(recording)[i]->data);
  }
  EXPECT_EQ(
      listener.exposures(),
      std::vector<int>(count, static_cast<int>(settings.exposure_ns / kNanosecondsPerMicrosecond)));
  expectOneOutputForEachFrame(recording, listener.outputs());
  expectSameImages(listener.outputs(), deblurWithoutRos(recording, testParameters()));

  events.sendInParts();
  frames.sendInParts();
  EXPECT_TRUE(waitUntil([&] { return listener.outputs().size() >= 2 * count; }))
      << listener.outputs().size();
  EXPECT_TRUE(waitUntil([&] {
    const diagnostic_msgs::DiagnosticStatus status = listener.report(ns + "/dv_stream:");
    return valueOf(status, "events: cuts") == "10" && valueOf(status, "frames: cuts") == "10" &&
           valueOf(status, "events: connected") == "yes" &&
           valueOf(status, "frames: received") == std::to_string(2 * count);
  })) << listener.report(ns + "/dv_stream:").message;
  expectEvents({recording, cut}, listener);
  EXPECT_EQ(listener.images().size(), 2 * count);
  EXPECT_EQ(listener.exposures().size(), 2 * count);
  EXPECT_EQ(valueOf(listener.report(ns + "/dv_stream:"), "events: stalls"), "0");
  EXPECT_TRUE(waitUntil([&] {
    return valueOf(listener.report(ns + "/deblur:"), "Event array gaps") == "10";
  })) << "the deblurring was not told what is missing";

  for (const auto& process : processes) {
    process->send(SIGINT);
  }
  for (const auto& process : processes) {
    EXPECT_EQ(process->wait(), 0);
  }
}

INSTANTIATE_TEST_SUITE_P(Ways, DvStream,
                         ::testing::Values(Way{"dvs", launchNodelets}, Way{"nodes", startNodes}));

}  // namespace
}  // namespace test
}  // namespace fast_edi
