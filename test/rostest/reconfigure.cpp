// Parameters changed while node or nodelet is at work, through the service that rqt and dynparam
// use, see reconfigure.test.
//
//   /tuned   close_timeout_ms 20000, explicit thresholds
//   /biased  thresholds from biases

#include <algorithm>
#include <atomic>
#include <cmath>
#include <condition_variable>
#include <cstdint>
#include <limits>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <dynamic_reconfigure/Config.h>
#include <dynamic_reconfigure/ConfigDescription.h>
#include <dynamic_reconfigure/Reconfigure.h>
#include <gtest/gtest.h>
#include <ros/init.h>
#include <ros/master.h>
#include <ros/param.h>
#include <ros/service.h>

#include "fast_edi/config/parameter_table.hpp"
#include "rostest/child_process.hpp"
#include "rostest/expectations.hpp"
#include "rostest/node_client.hpp"
#include "rostest/recording.hpp"

namespace fast_edi {
namespace test {
namespace {

using diagnostic_msgs::DiagnosticStatus;
using dynamic_reconfigure::Config;

template <typename Parameters, typename Value>
void append(const std::string& name, const Value& value, Parameters& parameters) {
  parameters.emplace_back();
  parameters.back().name = name;
  parameters.back().value = value;
}

/// A request, or part of a reply.
struct Values {
  Config config;
  Values&& number(const std::string& name, double value) && {
    append(name, value, config.doubles);
    return std::move(*this);
  }
  Values&& integer(const std::string& name, int value) && {
    append(name, value, config.ints);
    return std::move(*this);
  }
  Values&& flag(const std::string& name, bool value) && {
    append(name, value, config.bools);
    return std::move(*this);
  }
  Values&& text(const std::string& name, const std::string& value) && {
    append(name, value, config.strs);
    return std::move(*this);
  }
};

template <typename Parameters>
auto valueIn(const Parameters& parameters, const std::string& name) {
  const auto found = std::find_if(parameters.begin(), parameters.end(),
                                  [&name](const auto& entry) { return entry.name == name; });
  EXPECT_NE(found, parameters.end()) << name;
  return found == parameters.end() ? decltype(found->value){} : found->value;
}

double numberIn(const Config& config, const std::string& name) {
  return valueIn(config.doubles, name);
}

/// The next message of a latched or busy topic that meets a condition.
template <typename Message>
class Awaited {
 public:
  Awaited(ros::NodeHandle& nh, const std::string& topic) {
    subscriber_ =
        nh.subscribe<Message>(topic, 10, [this](const boost::shared_ptr<const Message>& message) {
          const std::lock_guard<std::mutex> lock(mutex_);
          last_ = message;
          changed_.notify_all();
        });
  }

  template <typename Condition>
  boost::shared_ptr<const Message> wait(const Condition& condition) {
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait_for(lock, kDeadline, [&] { return last_ && condition(*last_); });
    return last_;
  }
  boost::shared_ptr<const Message> wait() {
    return wait([](const Message&) { return true; });
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  boost::shared_ptr<const Message> last_;
  ros::Subscriber subscriber_;
};

class Reconfigure : public ::testing::Test {
 protected:
  void connectTo(const std::string& ns) {
    ns_ = ns;
    client_ = std::make_unique<NodeClient>(ns, ns + "/deblur");
    ASSERT_TRUE(ros::service::waitForService(ns + "/deblur/set_parameters", 30'000));
    start_ = call({});
    ASSERT_TRUE(client_->listen()) << ns << " did not subscribe to its inputs";
  }

  void TearDown() override {
    if (client_) {
      call(start_);  // the next test finds the node as it started
      EXPECT_TRUE(client_->stopListening()) << ns_ << " did not unsubscribe from its inputs";
    }
  }

  /// \return what is in force afterwards
  Config call(const Config& config) const {
    dynamic_reconfigure::Reconfigure reconfigure;
    reconfigure.request.config = config;
    EXPECT_TRUE(ros::service::call(ns_ + "/deblur/set_parameters", reconfigure));
    return reconfigure.response.config;
  }
  Config set(const Values& values) const { return call(values.config); }

  static Recording laterRecording() {
    RecordingSettings settings;
    ++epoch_;
    settings.start_ns += epoch_ * 100 * kNanosecondsPerSecond;
    settings.seed = static_cast<std::uint32_t>(epoch_);
    return makeRecording(settings);
  }

  /// As many outputs as the recording has frames.
  std::vector<Output> outputsOf(const Recording& recording) {
    client_->play(recording);
    return client_->waitForOutputs(imagesOf(recording).size());
  }

  std::string ns_;
  std::unique_ptr<NodeClient> client_;
  Config start_;

 private:
  static int epoch_;
};
int Reconfigure::epoch_ = 0;

TEST_F(Reconfigure, ShowsInTheImagesFromTheNextFrameOn) {
  connectTo("/tuned");
  const Recording recording = laterRecording();
  const std::size_t frames = imagesOf(recording).size();
  const std::size_t half = frames / 2;
  // Just before a frame arrives, with the events of its exposure there already.
  std::size_t seen = 0;
  const auto cut = std::find_if(
      recording.begin(), recording.end(),
      [&seen, half](const Arrival& arrival) { return arrival.image && seen++ == half; });
  client_->play({recording.begin(), cut});
  ASSERT_EQ(client_->waitForOutputs(half).size(), half);

  const Config reply = set(Values()
                               .number("contrast_threshold_on", 0.5)
                               .number("contrast_threshold_off", 0.4)
                               .flag("filter", false));
  EXPECT_EQ(numberIn(reply, "contrast_threshold_on"), 0.5);
  EXPECT_EQ(numberIn(reply, "contrast_threshold_off"), 0.4);

  client_->play({cut, recording.end()});
  const std::vector<Output> outputs = client_->waitForOutputs(frames);
  expectOneOutputForEachFrame(recording, outputs);
  DeblurParameters changed = testParameters();
  changed.thresholds = {0.5, 0.4};
  changed.filter.enabled = false;
  const std::vector<Output> before = deblurWithoutRos(recording, testParameters());
  const std::vector<Output> after = deblurWithoutRos(recording, changed);
  const auto at = [half](const std::vector<Output>& all) {
    return all.begin() + static_cast<std::ptrdiff_t>(half);
  };
  expectSameImages({outputs.begin(), at(outputs)}, {before.begin(), at(before)});
  expectSameImages({at(outputs), outputs.end()}, {at(after), after.end()});
  EXPECT_NE(outputs.back().image->data, before.back().image->data) << "a change that shows nothing";
}

TEST_F(Reconfigure, KeepsTheOldOfAValueOutOfRangeAndSaysSo) {
  connectTo("/tuned");
  Awaited<Config> updates(client_->nodeHandle(), "/tuned/deblur/parameter_updates");
  ASSERT_TRUE(updates.wait());

  const Config reply =
      set(Values()
              .number("contrast_threshold_on", -0.3)
              .number("exposure_time_us", 2e6)
              .number("filter_gain_noise", std::numeric_limits<double>::quiet_NaN())
              .text("reference", "middle")
              .number("time_offset_us", 1500.5));
  EXPECT_EQ(numberIn(reply, "contrast_threshold_on"), 0.3);
  EXPECT_EQ(numberIn(reply, "exposure_time_us"), 0.0);
  EXPECT_EQ(numberIn(reply, "filter_gain_noise"), 0.18);
  EXPECT_EQ(valueIn(reply.strs, "reference"), "mid");
  EXPECT_EQ(numberIn(reply, "time_offset_us"), 1500.5) << "a good value beside bad ones";

  const auto update = updates.wait(
      [](const Config& config) { return numberIn(config, "time_offset_us") == 1500.5; });
  EXPECT_EQ(numberIn(*update, "contrast_threshold_on"), 0.3);
  EXPECT_EQ(valueIn(update->strs, "reference"), "mid");
  EXPECT_EQ(ros::param::param("/tuned/deblur/contrast_threshold_on", 0.0), 0.3);
  EXPECT_EQ(ros::param::param("/tuned/deblur/time_offset_us", 0.0), 1500.5);

  EXPECT_TRUE(client_->waitForReport([](const DiagnosticStatus& status) {
    return valueOf(status, "Parameter values refused") == "4";
  })) << valueOf(client_->report(), "Parameter values refused");

  DeblurParameters shifted = testParameters();
  shifted.time_offset_ns = 1'500'500;
  const Recording recording = laterRecording();
  expectSameImages(outputsOf(recording), deblurWithoutRos(recording, shifted));
}

TEST_F(Reconfigure, NamesKeyValueAndRangeOfWhatItRefuses) {
  connectTo("/tuned");
  set(Values().number("close_timeout_ms", 0.0));
  EXPECT_TRUE(client_->waitForReport([](const DiagnosticStatus& status) {
    return status.level >= DiagnosticStatus::WARN &&
           status.message.find("close_timeout_ms: found '0', expected a number 1..60000 [ms]") !=
               std::string::npos;
  })) << client_->report().message;
}

/// Whatever is accepted is in force, whatever is refused leaves the old value, and the next request
/// works, up to the frames.
TEST_F(Reconfigure, TakesOverBothEndsOfEachRangeAndNothingTooSmallToMeanAnything) {
  connectTo("/tuned");
  for (const ParameterDescription& key : parameterDescriptions()) {
    if (!key.live || !key.limits) {
      continue;
    }
    SCOPED_TRACE(key.name);
    const bool integer = key.type == "integer";
    const auto after = [&](double value) {
      const Config reply = integer ? set(Values().integer(key.name, static_cast<int>(value)))
                                   : set(Values().number(key.name, value));
      return integer ? valueIn(reply.ints, key.name) : numberIn(reply, key.name);
    };
    EXPECT_EQ(after(key.limits->highest), key.limits->highest);
    EXPECT_EQ(after(key.limits->lowest), key.limits->lowest);
    if (key.limits->lowest > 0.0) {
      for (const double nothing : {1e-7, 1e-46}) {
        EXPECT_EQ(after(nothing), key.limits->lowest);
      }
    }
  }
  call(start_);
  const Recording recording = laterRecording();
  expectSameImages(outputsOf(recording), deblurWithoutRos(recording, testParameters()));
}

TEST_F(Reconfigure, DescribesTheRangesThatHold) {
  connectTo("/tuned");
  Awaited<dynamic_reconfigure::ConfigDescription> descriptions(
      client_->nodeHandle(), "/tuned/deblur/parameter_descriptions");
  const auto description = descriptions.wait();
  ASSERT_TRUE(description);
  EXPECT_EQ(numberIn(description->min, "contrast_threshold_on"), 0.0);
  EXPECT_EQ(numberIn(description->max, "contrast_threshold_on"), 10.0);
  EXPECT_EQ(numberIn(description->max, "exposure_time_us"), 1e6);
  EXPECT_EQ(numberIn(description->max, "frame_noise_dn"), 50.0);
  EXPECT_EQ(valueIn(description->max.ints, "latent_images"), 1000);
}

TEST_F(Reconfigure, WorksByTheCommandLineTool) {
  connectTo("/tuned");
  ChildProcess tool(
      {"rosrun", "dynamic_reconfigure", "dynparam", "set", "/tuned/deblur", "passthrough", "true"});
  ASSERT_EQ(tool.wait(), 0);
  const Recording recording = laterRecording();
  const std::vector<Output> outputs = outputsOf(recording);
  expectOneOutputForEachFrame(recording, outputs);
  EXPECT_EQ(countChanged(recording, outputs), 0);
}

TEST_F(Reconfigure, BeginsAndEndsTheHighRateVideo) {
  connectTo("/tuned");
  // Those of the recording at hand: images of the one before may still be on their way.
  std::atomic<int> images{0};
  std::atomic<std::uint64_t> since_ns{0};
  const ros::Subscriber latent = client_->nodeHandle().subscribe<sensor_msgs::Image>(
      "/tuned/latent/image_raw", 1000, [&](const sensor_msgs::ImageConstPtr& image) {
        images += image->width == 64 && image->header.stamp.toNSec() >= since_ns ? 1 : 0;
      });
  ASSERT_TRUE(waitUntil([] { return publisherSendsToUs("/tuned/latent/image_raw"); }));
  std::size_t outputs = 0;
  const auto film = [&] {
    const Recording recording = laterRecording();
    since_ns = imagesOf(recording).front()->header.stamp.toNSec();
    images = 0;
    outputs += imagesOf(recording).size();
    client_->play(recording);
    EXPECT_EQ(client_->waitForOutputs(outputs).size(), outputs);
  };
  film();
  EXPECT_EQ(images, 0);
  set(Values().integer("latent_images", 3));
  film();
  EXPECT_TRUE(waitUntil([&images] { return images > 0; }));
  set(Values().integer("latent_images", 0));
  film();
  EXPECT_EQ(images, 0);
}

TEST_F(Reconfigure, LeavesTheContrastToTheBiasesUnlessToldOtherwise) {
  connectTo("/biased");
  const auto shows = [](const std::string& on, const std::string& off) {
    return [on, off](const DiagnosticStatus& status) {
      return valueOf(status, "Contrast threshold ON").substr(0, on.size()) == on &&
             valueOf(status, "Contrast threshold OFF").substr(0, off.size()) == off;
    };
  };
  EXPECT_EQ(numberIn(start_, "contrast_threshold_on"), 0.0);
  EXPECT_FALSE(ros::param::has("/biased/deblur/contrast_threshold_on"));
  EXPECT_TRUE(client_->waitForReport(shows("0.2609", "0.2415")));
  set(Values().number("time_offset_us", 10.0));
  EXPECT_TRUE(client_->waitForReport(shows("0.2609", "0.2415")));

  // A value of its own wins over the driver's biases, which decide the other.
  set(Values().number("contrast_threshold_on", 0.5));
  EXPECT_TRUE(client_->waitForReport(shows("0.5000", "0.2415")));
  EXPECT_EQ(ros::param::param("/biased/deblur/contrast_threshold_on", 0.0), 0.5);
  ros::Publisher driver = client_->nodeHandle().advertise<Config>("bias_updates", 1, true);
  driver.publish(Values()
                     .integer("DiffBn_coarse", 4)
                     .integer("DiffBn_fine", 39)
                     .integer("ONBn_coarse", 6)
                     .integer("ONBn_fine", 200)
                     .integer("OFFBn_coarse", 4)
                     .integer("OFFBn_fine", 2)
                     .config);
  EXPECT_TRUE(client_->waitForReport(shows("0.5000", "0.1958")))
      << valueOf(client_->report(), "Contrast threshold OFF");

  // Given back to the biases: those of the driver.
  set(Values().number("contrast_threshold_on", 0.0));
  EXPECT_TRUE(client_->waitForReport([&shows](const DiagnosticStatus& status) {
    return shows("0.3819", "0.1958")(status) &&
           valueOf(status, "Contrast from") == "biases on /biased/bias_updates";
  })) << valueOf(client_->report(), "Contrast threshold ON");
  EXPECT_FALSE(ros::param::has("/biased/deblur/contrast_threshold_on"));
}

}  // namespace
}  // namespace test
}  // namespace fast_edi

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "reconfigure");
  const ros::NodeHandle keeps_ros_running;
  return RUN_ALL_TESTS();
}
