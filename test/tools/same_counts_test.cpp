/// What becomes of the frames of a recording, as /diagnostics, `deblur_bag` and `validate_bag`
/// count it: one recording with each kind of fault.
#include <array>
#include <cstdint>
#include <memory>
#include <ostream>
#include <string>

#include <gmock/gmock.h>
#include <ros/callback_queue.h>
#include <ros/init.h>
#include <ros/master.h>
#include <ros/node_handle.h>
#include <ros/param.h>
#include <ros/spinner.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>

#include "fast_edi/base/deblur_counters.hpp"
#include "node/deblur_node.hpp"
#include "rostest/node_client.hpp"
#include "rostest/recording.hpp"
#include "rostest/ros_master.hpp"
#include "simulation/recording_faults.hpp"
#include "support/command.hpp"
#include "support/temporary_directory.hpp"

namespace fast_edi {
namespace {

using fast_edi::testing::CommandResult;
using fast_edi::testing::runCommand;

const std::string kTools = std::string(FAST_EDI_TOOLS_DIR) + "/";
/// Frames wait long enough for a machine that is busy.
const std::string kParameters =
    " contrast_threshold_on:=0.26 contrast_threshold_off:=0.24 close_timeout_ms:=400";
const std::string kNode = "/dvs/deblur";

/// Outcomes of frames.
struct Counts {
  std::uint64_t deblurred = 0;
  std::uint64_t still = 0;
  std::array<std::uint64_t, kPassReasonCount> passed{};
  std::uint64_t suppressed = 0;

  friend bool operator==(const Counts& a, const Counts& b) {
    return a.deblurred == b.deblurred && a.still == b.still && a.passed == b.passed &&
           a.suppressed == b.suppressed;
  }
};

void PrintTo(const Counts& counts, std::ostream* out) {
  *out << counts.deblurred << " deblurred (" << counts.still << " still), " << counts.suppressed
       << " suppressed";
  for (std::size_t i = 0; i < kPassReasonCount; ++i) {
    if (counts.passed[i] > 0) {
      *out << ", " << counts.passed[i] << " " << toString(static_cast<PassReason>(i));
    }
  }
}

/// The number before a text, 0 where there is none.
std::uint64_t numberBefore(const std::string& text, const std::string& words) {
  const std::size_t at = text.find(words);
  if (at == std::string::npos) {
    return 0;
  }
  const std::size_t end = text.find_last_of("0123456789", at);
  const std::size_t begin = text.find_last_not_of("0123456789", end);
  return std::stoull(text.substr(begin + 1, end - begin));
}

Counts countsOf(const std::string& text, const std::string& still, const std::string& before) {
  Counts counts;
  counts.deblurred = numberBefore(text, " deblurred");
  counts.still = numberBefore(text, still);
  counts.suppressed = numberBefore(text, " without output: ");
  for (std::size_t i = 0; i < kPassReasonCount; ++i) {
    counts.passed[i] = numberBefore(text, before + toString(static_cast<PassReason>(i)));
  }
  return counts;
}

test::Recording readRecording(const std::string& path) {
  test::Recording recording;
  const rosbag::Bag bag(path);
  for (const rosbag::MessageInstance& message : rosbag::View(bag)) {
    test::Arrival arrival;
    arrival.time_ns = static_cast<std::int64_t>(message.getTime().toNSec());
    if (message.getTopic() == "/dvs/events") {
      arrival.events = message.instantiate<EventArray>();
    } else if (message.getTopic() == "/dvs/image_raw") {
      arrival.image = message.instantiate<sensor_msgs::Image>();
    } else if (message.getTopic() == "/dvs/exposure") {
      arrival.exposure = message.instantiate<std_msgs::Int32>();
    } else if (message.getTopic() == "/dvs/camera_info") {
      arrival.info = message.instantiate<sensor_msgs::CameraInfo>();
    } else {
      continue;
    }
    recording.push_back(arrival);
  }
  return recording;
}

class SameCountsTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    master_ = std::make_unique<test::RosMaster>();
    ros::init(ros::M_string(), "same_counts",
              ros::init_options::NoSigintHandler | ros::init_options::NoRosout);
    ASSERT_TRUE(test::waitUntil([] { return ros::master::check(); }));
    ros::param::set(kNode + "/contrast_threshold_on", 0.26);
    ros::param::set(kNode + "/contrast_threshold_off", 0.24);
    ros::param::set(kNode + "/close_timeout_ms", 400.0);
    ros::start();
  }
  static void TearDownTestSuite() {
    ros::shutdown();
    master_.reset();
  }

  std::string simulate(const std::string& options) {
    const std::string bag = directory_.file("recording.bag");
    const CommandResult result =
        runCommand(kTools + "simulate_davis --overwrite --no-ground-truth --frames 8 --width 64 " +
                   "--height 48 --motion pan --texture natural --out " + bag + " " + options);
    EXPECT_EQ(result.exit_code, 0) << result.output;
    return bag;
  }
  Counts byDeblurBag(const std::string& bag) {
    const CommandResult result = runCommand(kTools + "deblur_bag --force --in " + bag + " --out " +
                                            directory_.file("out.bag") + kParameters);
    const Counts counts = countsOf(result.output, "  of these without any event", "  of these: ");
    constexpr int kNothingDeblurred = 3;
    EXPECT_EQ(result.exit_code, counts.deblurred > 0 ? 0 : kNothingDeblurred) << result.output;
    return counts;
  }
  static Counts byValidateBag(const std::string& bag) {
    const CommandResult result = runCommand(kTools + "validate_bag " + bag + kParameters);
    const std::string intro = "with these parameters: ";
    const std::size_t at = result.output.find(intro);
    EXPECT_NE(at, std::string::npos) << result.output;
    const std::string line =
        result.output.substr(at + intro.size(), result.output.find('\n', at) - at - intro.size());
    return countsOf(line, " of them without any event", " ");
  }
  static Counts byDiagnostics(const std::string& bag) {
    const test::Recording recording = readRecording(bag);
    ros::CallbackQueue queue;
    ros::AsyncSpinner spinner(1, &queue);
    spinner.start();
    ros::NodeHandle node_nh("/dvs");
    ros::NodeHandle private_nh(kNode);
    node_nh.setCallbackQueue(&queue);
    private_nh.setCallbackQueue(&queue);
    const DeblurNode node(node_nh, private_nh, kNode);
    EXPECT_EQ(node.configurationError(), "");
    test::NodeClient client("/dvs", kNode);
    EXPECT_TRUE(client.listen());
    client.play(recording);
    const auto number = [](const diagnostic_msgs::DiagnosticStatus& status,
                           const std::string& key) {
      const std::string value = test::valueOf(status, key);
      return value.empty() ? std::uint64_t{0} : std::stoull(value);
    };
    const std::size_t frames = test::imagesOf(recording).size();
    EXPECT_TRUE(client.waitForReport([&](const diagnostic_msgs::DiagnosticStatus& status) {
      return number(status, "Frames in") == frames &&
             number(status, "Frames out") + number(status, "Frames without output") == frames;
    }));
    const diagnostic_msgs::DiagnosticStatus status = client.report();
    Counts counts;
    counts.deblurred = number(status, "Frames deblurred");
    counts.still = number(status, "Frames without an event");
    counts.suppressed = number(status, "Frames without output");
    for (std::size_t i = 0; i < kPassReasonCount; ++i) {
      counts.passed[i] = number(
          status, std::string("Frames passed through: ") + toString(static_cast<PassReason>(i)));
    }
    return counts;
  }

  TemporaryDirectory directory_;

 private:
  static std::unique_ptr<test::RosMaster> master_;
};
std::unique_ptr<test::RosMaster> SameCountsTest::master_;

TEST_F(SameCountsTest, BothToolsAgreeForEachFault) {
  for (const FaultDescription& fault : faultDescriptions()) {
    const std::string bag = simulate(std::string("--fault ") + fault.name);
    EXPECT_EQ(byDeblurBag(bag), byValidateBag(bag)) << fault.name;
  }
}

TEST_F(SameCountsTest, DiagnosticsAgreeWithBoth) {
  for (const char* options :
       {"", "--no-exposure", "--fault clock-offset=5000000", "--fault frame-stamps-times",
        "--fault dropped-arrays", "--fault repeated-stamp --fault more-rows",
        "--fault unknown-encoding", "--fault event-hole"}) {
    const std::string bag = simulate(options);
    const Counts counts = byDeblurBag(bag);
    EXPECT_EQ(counts, byValidateBag(bag)) << options;
    EXPECT_EQ(counts, byDiagnostics(bag)) << options;
  }
}

TEST_F(SameCountsTest, NoFrameOfAnotherClockCountsAsDeblurred) {
  for (const char* fault :
       {"clock-offset=5000000", "clock-offset=-5000000", "frame-stamps-times"}) {
    const Counts counts = byDeblurBag(simulate(std::string("--fault ") + fault));
    EXPECT_EQ(counts.deblurred, 0u) << fault;
    EXPECT_EQ(counts.passed[static_cast<std::size_t>(PassReason::kClocksDiffer)], 8u) << fault;
  }
}

}  // namespace
}  // namespace fast_edi
