// The node between threads: everything that may happen at the same time does. What there is to
// expect of the images is tested elsewhere; here it is that the node works on, and, with
// ThreadSanitizer, that no two threads meet at the same data.

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <diagnostic_msgs/DiagnosticArray.h>
#include <dynamic_reconfigure/Config.h>
#include <gmock/gmock.h>
#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/param.h>
#include <ros/spinner.h>
#include <sensor_msgs/Image.h>

#include "fast_edi/messages/steady_time.hpp"
#include "node/deblur_node.hpp"
#include "rostest/child_process.hpp"
#include "rostest/node_client.hpp"
#include "rostest/ros_process.hpp"
#include "rostest/stub_camera.hpp"

namespace fast_edi {
namespace {

constexpr int kNodes = 4;
/// Recording time passes this much faster than the clock on the wall.
constexpr int kHaste = 2;
const std::string kNamespace = "/camera";
const std::string kNode = "/camera/deblur";

/// Changes the driver's biases, and with them the thresholds, all the time.
class Reconfigurer {
 public:
  Reconfigurer() {
    publisher_ =
        ros::NodeHandle(kNamespace).advertise<dynamic_reconfigure::Config>("bias_updates", 1);
    thread_ = std::thread([this] {
      for (int i = 0; !stop_; ++i) {
        publisher_.publish(biases(i % 2 == 0 ? 200 : 220));
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
      }
    });
  }
  ~Reconfigurer() {
    stop_ = true;
    thread_.join();
  }

 private:
  static dynamic_reconfigure::Config biases(int on_fine) {
    dynamic_reconfigure::Config config;
    for (const auto& [name, value] :
         std::vector<std::pair<std::string, int>>{{"DiffBn_coarse", 4},
                                                  {"DiffBn_fine", 39},
                                                  {"ONBn_coarse", 6},
                                                  {"ONBn_fine", on_fine},
                                                  {"OFFBn_coarse", 4},
                                                  {"OFFBn_fine", 1}}) {
      dynamic_reconfigure::IntParameter parameter;
      parameter.name = name;
      parameter.value = value;
      config.ints.push_back(parameter);
    }
    return config;
  }

  ros::Publisher publisher_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

/// Changes parameters through the node's service all the time, while frames close. A process of its
/// own: with both ends in one, ThreadSanitizer reports the locks of roscpp's connections.
/// - contrast_threshold_on: out of range, from biases, and two values of its own
/// - latent_images: a film that begins and ends
const char* const kTuner = R"(
import itertools, rospy, signal, time
from dynamic_reconfigure.msg import BoolParameter, Config, DoubleParameter, IntParameter
from dynamic_reconfigure.srv import Reconfigure
signal.signal(signal.SIGINT, signal.SIG_DFL)  # the end, without a word
call = rospy.ServiceProxy('/camera/deblur/set_parameters', Reconfigure)
for i in itertools.count():
    try:
        call(Config(doubles=[DoubleParameter('contrast_threshold_on', 0.1 * (i % 4 - 1))],
                    ints=[IntParameter('latent_images', 4 if i % 4 == 0 else 0)],
                    bools=[BoolParameter('filter', i % 2 == 0)]))
    except rospy.ServiceException:
        pass  # there is no node at the moment
    time.sleep(0.02)
)";

/// Subscribes to an output and leaves after a few images, again and again.
class PassingConsumer {
 public:
  /// \param patience images until it leaves
  PassingConsumer(std::string topic, std::size_t patience)
      : topic_(std::move(topic)), patience_(patience) {
    thread_ = std::thread([this] {
      while (!stop_) {
        visit();
      }
    });
  }
  ~PassingConsumer() {
    stop_ = true;
    thread_.join();
  }

  std::size_t images() const { return images_; }
  /// Images with a stamp not later than that of the image before.
  std::size_t outOfOrder() const { return out_of_order_; }

 private:
  void visit() {
    ros::CallbackQueue queue;
    ros::NodeHandle nh(kNamespace);
    nh.setCallbackQueue(&queue);
    std::size_t seen = 0;
    sensor_msgs::ImageConstPtr last;
    const ros::Subscriber subscriber = nh.subscribe<sensor_msgs::Image>(
        topic_, 100, [this, &seen, &last](const sensor_msgs::ImageConstPtr& image) {
          if (image == last) {
            return;  // roscpp connects twice within a process when both ends come at once
          }
          out_of_order_ += last && image->header.stamp <= last->header.stamp ? 1 : 0;
          last = image;
          ++seen;
          ++images_;
        });
    while (seen < patience_ && !stop_) {
      queue.callAvailable(ros::WallDuration(0.01));
    }
  }

  const std::string topic_;
  const std::size_t patience_;
  std::atomic<bool> stop_{false};
  std::atomic<std::size_t> images_{0};
  std::atomic<std::size_t> out_of_order_{0};
  std::thread thread_;
};

/// The parameter: how many threads call the callbacks of the node. One is what the node asks for.
class DeblurNodeThreads : public ::testing::TestWithParam<std::uint32_t> {
 protected:
  static void SetUpTestSuite() {
    test::requireRos();
    for (const auto& [name, value] : std::vector<std::pair<std::string, int>>{{"DiffBn_coarse", 4},
                                                                              {"DiffBn_fine", 39},
                                                                              {"OnBn_coarse", 5},
                                                                              {"OnBn_fine", 255},
                                                                              {"OffBn_coarse", 4},
                                                                              {"OffBn_fine", 1}}) {
      ros::param::set(kNode + "/biases/" + name, value);
    }
    ros::param::set(kNode + "/latent_images", 1);
  }
};

TEST_P(DeblurNodeThreads, WorksWhileEverybodyComesAndGoes) {
  ros::CallbackQueue reports;
  std::string internal_errors;
  int changes = 0;  // of parameters, in the report that has most
  double longest_close_ms = 0.0;
  const std::int64_t began_ns = steadyNow();
  ros::NodeHandle nh;
  nh.setCallbackQueue(&reports);
  const ros::Subscriber diagnostics = nh.subscribe<diagnostic_msgs::DiagnosticArray>(
      "/diagnostics", 10, [&](const diagnostic_msgs::DiagnosticArrayConstPtr& array) {
        for (const diagnostic_msgs::DiagnosticStatus& status : array->status) {
          internal_errors += test::valueOf(status, "Internal errors");
          changes =
              std::max(changes, std::atoi(test::valueOf(status, "Parameter changes").c_str()));
          longest_close_ms = std::max(
              longest_close_ms, std::atof(test::valueOf(status, "Close latency p99 [ms]").c_str()));
        }
      });

  test::RecordingSettings settings;
  settings.frames = 5;
  const test::StubCamera camera(kNamespace, settings, kHaste);
  const Reconfigurer reconfigurer;
  const test::ChildProcess tuner({"/usr/bin/python3", "-c", kTuner});
  const PassingConsumer first("deblurred/image_raw", 10);
  const PassingConsumer second("deblurred/image_raw", 4);
  const PassingConsumer spectator("comparison", 3);
  const PassingConsumer filmgoer("latent/image_raw", 3);
  for (int i = 0; i < kNodes; ++i) {
    SCOPED_TRACE(i);
    ros::CallbackQueue queue;
    ros::AsyncSpinner spinner(GetParam(), &queue);
    spinner.start();
    ros::NodeHandle node_nh(kNamespace);
    ros::NodeHandle private_nh(kNode);
    node_nh.setCallbackQueue(&queue);
    private_nh.setCallbackQueue(&queue);
    const DeblurNode node(node_nh, private_nh, kNode);
    ASSERT_EQ(node.configurationError(), "");
    const std::size_t before = first.images();
    const std::size_t comparisons_before = spectator.images();
    const std::size_t latent_before = filmgoer.images();
    // Several threads disturb the order of arrival, and frames may have to wait for their timeout.
    const std::size_t expected = GetParam() == 1 ? 3 : 1;
    EXPECT_TRUE(test::waitUntil([&] { return first.images() >= before + expected; }));
    if (i + 1 == kNodes) {
      EXPECT_TRUE(test::waitUntil([&] {
        reports.callAvailable();
        return !internal_errors.empty() && changes > 0 && spectator.images() > comparisons_before &&
               filmgoer.images() > latent_before;
      }));
    }
  }
  EXPECT_GT(second.images(), 0u);
  EXPECT_GT(changes, 0);
  EXPECT_EQ(first.outOfOrder() + second.outOfOrder(), 0u);
  // These arrays were never on the wire; still they have a time of arrival.
  EXPECT_GT(longest_close_ms, 0.0);
  EXPECT_LE(longest_close_ms * static_cast<double>(kNanosecondsPerMillisecond),
            static_cast<double>(steadyNow() - began_ns));
  EXPECT_THAT(internal_errors, ::testing::MatchesRegex("0+"));
}

INSTANTIATE_TEST_SUITE_P(ThreadsOfTheQueue, DeblurNodeThreads, ::testing::Values(1, 3));

}  // namespace
}  // namespace fast_edi
