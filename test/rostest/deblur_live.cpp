// Node and nodelet as their users see them: the same tests for both, see deblur.test.
//
// These instances run in namespaces of their own:
//   /long_timeout   close_timeout_ms 20000: what is deblurred depends on no timing
//   /quick     close_timeout_ms 100: what happens without events or exposures
//   /fallback  as /quick, with exposure_time_us
//   /unexposed as /quick
//   /biased    thresholds from biases
//   /crowded   max_buffered_events 1000
//   /filmed    as /long_timeout, with latent_images 4

#include <algorithm>
#include <condition_variable>
#include <future>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <dynamic_reconfigure/Config.h>
#include <gtest/gtest.h>
#include <ros/init.h>
#include <boost/make_shared.hpp>

#include "rostest/child_process.hpp"
#include "rostest/expectations.hpp"
#include "rostest/node_client.hpp"
#include "rostest/recording.hpp"
#include "rostest/stub_camera.hpp"
#include "support/temporary_directory.hpp"

namespace fast_edi {
namespace test {

/// An event array that claims 2^32 - 1 events and holds none.
struct LyingArray {};

}  // namespace test
}  // namespace fast_edi

namespace ros {
namespace message_traits {

template <>
struct MD5Sum<fast_edi::test::LyingArray> {
  static const char* value() { return MD5Sum<fast_edi::EventArray>::value(); }
  static const char* value(const fast_edi::test::LyingArray&) { return value(); }
};
template <>
struct DataType<fast_edi::test::LyingArray> {
  static const char* value() { return DataType<fast_edi::EventArray>::value(); }
  static const char* value(const fast_edi::test::LyingArray&) { return value(); }
};
template <>
struct Definition<fast_edi::test::LyingArray> {
  static const char* value() { return Definition<fast_edi::EventArray>::value(); }
  static const char* value(const fast_edi::test::LyingArray&) { return value(); }
};

}  // namespace message_traits

namespace serialization {

template <>
struct Serializer<fast_edi::test::LyingArray> {
  template <typename Stream>
  static void write(Stream& stream, const fast_edi::test::LyingArray&) {
    stream.next(std_msgs::Header());
    stream.next(std::uint32_t{48});
    stream.next(std::uint32_t{64});
    stream.next(std::uint32_t{0xffffffff});
  }
  static std::uint32_t serializedLength(const fast_edi::test::LyingArray&) {
    return serializationLength(std_msgs::Header()) + 3 * sizeof(std::uint32_t);
  }
};

}  // namespace serialization
}  // namespace ros

namespace fast_edi {
namespace test {
namespace {

using diagnostic_msgs::DiagnosticStatus;

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

class Live : public ::testing::Test {
 protected:
  void connectTo(const std::string& ns) {
    ns_ = ns;
    client_ = std::make_unique<NodeClient>(ns, ns + "/deblur");
    ASSERT_TRUE(client_->listen()) << ns << " did not subscribe to its inputs";
  }

  void TearDown() override {
    if (client_) {
      EXPECT_TRUE(client_->stopListening()) << ns_ << " did not unsubscribe from its inputs";
    }
  }

  /// A recording whose times are later than those of all tests before, as those of a driver are.
  static RecordingSettings laterSettings() {
    RecordingSettings settings;
    ++epoch_;
    settings.start_ns += epoch_ * 100 * kNanosecondsPerSecond;
    settings.seed = static_cast<std::uint32_t>(epoch_);
    return settings;
  }

  /// Plays a recording into a node that is not in a hurry, and compares with the pipeline alone.
  void expectDeblurred(const Recording& recording, const DeblurParameters& parameters) {
    client_->play(recording);
    const std::vector<Output> outputs = client_->waitForOutputs(imagesOf(recording).size());
    expectOneOutputForEachFrame(recording, outputs);
    expectSameImages(outputs, deblurWithoutRos(recording, parameters));
    EXPECT_EQ(countChanged(recording, outputs), static_cast<int>(outputs.size()))
        << "frames were passed through";
  }

  std::string ns_;
  std::unique_ptr<NodeClient> client_;

 private:
  static int epoch_;
};
int Live::epoch_ = 0;

TEST_F(Live, DeblursWhatAnotherProcessPublishes) {
  connectTo("/long_timeout");
  RecordingSettings settings = laterSettings();
  settings.size = {346, 260};
  settings.frames = 20;
  expectDeblurred(makeRecording(settings), testParameters());
}

TEST_F(Live, TakesABreakFromEventsThatAreTooMany) {
  connectTo("/crowded");
  RecordingSettings settings = laterSettings();
  settings.event_period_ns = 5 * kNanosecondsPerMicrosecond;  // an array holds several thousand
  {
    const StubCamera camera("/crowded", settings, 1);
    const auto suspended = [this](int times) {
      return client_->waitForReport([times](const DiagnosticStatus& status) {
        return valueOf(status, "Event suspensions") == std::to_string(times);
      });
    };
    ASSERT_TRUE(suspended(1));
    ASSERT_TRUE(suspended(2)) << "the events did not come back";
    EXPECT_TRUE(client_->waitForReport([](const DiagnosticStatus& status) {
      return contains(status.message, "no events on /crowded/events were received for 2.0 s");
    }));
  }
  EXPECT_TRUE(waitUntil([this] { return client_->allInputsConnected(); }));
  EXPECT_TRUE(client_->waitForReport([](const DiagnosticStatus& status) {
    return valueOf(status, "Frames in") == valueOf(status, "Frames out") &&
           valueOf(status, "Backlog: waiting frames") == "0";
  })) << "frames were lost";
  EXPECT_NE(valueOf(client_->report(), "Event array gaps"), "0");
  EXPECT_EQ(valueOf(client_->report(), "Frames deblurred"), "0");
}

TEST_F(Live, KeepsEveryEncoding) {
  connectTo("/long_timeout");
  for (const char* encoding : {"8UC1", "mono16", "bayer_rggb8", "rgb8", "bgr8"}) {
    ASSERT_TRUE(client_->stopListening());
    ASSERT_TRUE(client_->listen());
    RecordingSettings settings = laterSettings();
    settings.encoding = encoding;
    settings.frames = 3;
    SCOPED_TRACE(encoding);
    expectDeblurred(makeRecording(settings), testParameters());
  }
}

TEST_F(Live, NamesTheFrameOfImagesThatHaveNone) {
  connectTo("/long_timeout");
  RecordingSettings settings = laterSettings();
  settings.frame_id = "";
  settings.frames = 2;
  expectDeblurred(makeRecording(settings), testParameters());
}

TEST_F(Live, DeblursABagPlayedAtRealSpeed) {
  connectTo("/long_timeout");
  const Recording recording = makeRecording(laterSettings());
  const TemporaryDirectory directory;
  const std::string path = directory.file("played.bag");
  writeBag(recording, "/long_timeout", path);
  ChildProcess player({"rosbag", "play", "--quiet", "--wait-for-subscribers", path});
  EXPECT_EQ(player.wait(), 0);
  const std::vector<Output> outputs = client_->waitForOutputs(imagesOf(recording).size());
  expectOneOutputForEachFrame(recording, outputs);
  expectSameImages(outputs, deblurWithoutRos(recording, testParameters()));
}

TEST_F(Live, StartsAnewWhenABagIsPlayedInALoop) {
  connectTo("/long_timeout");
  RecordingSettings settings = laterSettings();
  settings.frames = 20;  // longer than max_backward_jump_ms
  const Recording recording = makeRecording(settings);
  const TemporaryDirectory directory;
  const std::string path = directory.file("looped.bag");
  writeBag(recording, "/long_timeout", path);
  const std::size_t frames = imagesOf(recording).size();
  std::vector<Output> outputs;
  {
    const ChildProcess player(
        {"rosrun", "rosbag", "play", "--quiet", "--wait-for-subscribers", "--loop", path});
    outputs = client_->waitForOutputs(2 * frames);
  }
  ASSERT_GE(outputs.size(), 2 * frames);
  const auto second = outputs.begin() + static_cast<std::ptrdiff_t>(frames);
  const std::vector<Output> expected = deblurWithoutRos(recording, testParameters());
  expectSameImages({outputs.begin(), second}, expected);
  expectSameImages({second, second + static_cast<std::ptrdiff_t>(frames)}, expected);
}

TEST_F(Live, WaitsForTheEventsOfAFrame) {
  connectTo("/long_timeout");
  RecordingSettings settings = laterSettings();
  settings.frames = 1;
  const Recording recording = makeRecording(settings);
  // Everything but events from the middle of the exposure on, which come last.
  const std::int64_t hold_ns = settings.start_ns + settings.first_exposure_ns;
  Recording late;
  for (const Arrival& arrival : recording) {
    if (arrival.events && arrival.time_ns > hold_ns) {
      late.push_back(arrival);
    } else {
      client_->publish(arrival);
    }
  }
  ASSERT_FALSE(late.empty());
  ASSERT_TRUE(client_->waitForReport([](const DiagnosticStatus& status) {
    return valueOf(status, "Backlog: waiting frames") == "1" &&
           valueOf(status, "Exposures in") != "0";
  })) << client_->report().message;
  EXPECT_EQ(client_->outputCount(), 0u) << "closed before its events came";
  for (const Arrival& arrival : late) {
    client_->publish(arrival);
  }
  const std::vector<Output> outputs = client_->waitForOutputs(1);
  expectOneOutputForEachFrame(recording, outputs);
  expectSameImages(outputs, deblurWithoutRos(recording, testParameters()));
}

TEST_F(Live, TakesAStillSceneForSharp) {
  connectTo("/quick");
  RecordingSettings settings = laterSettings();
  settings.frames = 2;
  settings.frame_period_ns = 400 * kNanosecondsPerMillisecond;
  Recording recording = makeRecording(settings);
  // The events end between the two exposures.
  const std::int64_t still_ns = settings.start_ns + 200 * kNanosecondsPerMillisecond;
  recording.erase(std::remove_if(recording.begin(), recording.end(),
                                 [still_ns](const Arrival& arrival) {
                                   return arrival.events && arrival.time_ns > still_ns;
                                 }),
                  recording.end());
  client_->play(recording);
  const std::vector<Output> outputs = client_->waitForOutputs(2);
  expectOneOutputForEachFrame(recording, outputs);
  expectSameImages(outputs, deblurWithoutRos(recording, testParameters()));
  EXPECT_TRUE(client_->waitForReport([](const DiagnosticStatus& status) {
    return valueOf(status, "Frames without an event") != "0" &&
           valueOf(status, "Frames closed by timeout") != "0";
  })) << client_->report().message;
}

TEST_F(Live, PassesFramesThroughWithoutAnyEvents) {
  connectTo("/quick");
  Recording recording = makeRecording(laterSettings());
  recording.erase(std::remove_if(recording.begin(), recording.end(),
                                 [](const Arrival& arrival) { return arrival.events != nullptr; }),
                  recording.end());
  client_->play(recording);
  const std::vector<Output> outputs = client_->waitForOutputs(imagesOf(recording).size());
  expectOneOutputForEachFrame(recording, outputs);
  EXPECT_EQ(countChanged(recording, outputs), 0);
  EXPECT_TRUE(client_->waitForReport([](const DiagnosticStatus& status) {
    return status.level == DiagnosticStatus::ERROR &&
           contains(status.message, "no event array on /quick/events");
  })) << client_->report().message;
}

TEST_F(Live, PassesFramesThroughWithoutAnyExposure) {
  connectTo("/unexposed");  // no other test sends exposures there: the last one would be taken
  RecordingSettings settings = laterSettings();
  settings.exposures = false;
  settings.frames = 40;  // reports come once a second: one of them in the midst
  const Recording recording = makeRecording(settings);
  const std::future<void> playing =
      std::async(std::launch::async, [this, &recording] { client_->play(recording); });
  EXPECT_TRUE(client_->waitForReport([](const DiagnosticStatus& status) {
    return status.level == DiagnosticStatus::WARN &&
           contains(status.message, "exposure unknown; expected messages on /unexposed/exposure") &&
           contains(status.message, "exposure_time_us");
  })) << client_->report().message;
  playing.wait();
  const std::vector<Output> outputs = client_->waitForOutputs(imagesOf(recording).size());
  expectOneOutputForEachFrame(recording, outputs);
  EXPECT_EQ(countChanged(recording, outputs), 0);
}

TEST_F(Live, FallsBackToTheExposureParameter) {
  connectTo("/fallback");
  RecordingSettings settings = laterSettings();
  settings.exposures = false;
  const Recording recording = makeRecording(settings);
  DeblurParameters parameters = testParameters();
  parameters.exposure_time_ns = settings.exposure_ns;
  expectDeblurred(recording, parameters);
}

TEST_F(Live, PassesUnsupportedEncodingsThrough) {
  connectTo("/quick");
  auto image =
      boost::make_shared<sensor_msgs::Image>(*imagesOf(makeRecording(laterSettings())).front());
  image->encoding = "32FC1";
  image->step = image->width * 4;
  image->data.resize(std::size_t{image->step} * image->height, 7);
  client_->publish(image);
  const std::vector<Output> outputs = client_->waitForOutputs(1);
  ASSERT_EQ(outputs.size(), 1u);
  EXPECT_EQ(outputs[0].image->encoding, "32FC1");
  EXPECT_EQ(outputs[0].image->data, image->data);
  EXPECT_EQ(outputs[0].image->header.stamp, image->header.stamp);
  EXPECT_TRUE(client_->waitForReport([](const DiagnosticStatus& status) {
    return contains(status.message, "encoding \"32FC1\", expected mono8");
  })) << client_->report().message;
}

TEST_F(Live, RefusesMalformedImages) {
  connectTo("/long_timeout");
  RecordingSettings settings = laterSettings();
  settings.frames = 3;
  const Recording recording = makeRecording(settings);
  auto lying = boost::make_shared<sensor_msgs::Image>(*imagesOf(recording).front());
  lying->height = 1'000'000;
  client_->publish(lying);
  EXPECT_TRUE(client_->waitForReport([](const DiagnosticStatus& status) {
    return contains(status.message, "/long_timeout/image_raw refused") &&
           contains(status.message, "bytes of data, expected at least");
  })) << client_->report().message;
  expectDeblurred(recording, testParameters());
}

TEST_F(Live, SurvivesEventArraysThatLieAboutTheirLength) {
  connectTo("/long_timeout");
  RecordingSettings settings = laterSettings();
  settings.frames = 3;
  const Recording recording = makeRecording(settings);
  const ros::Publisher liar = client_->nodeHandle().advertise<LyingArray>("events", 10);
  ASSERT_TRUE(waitUntil([&liar] { return liar.getNumSubscribers() > 0; }));
  for (int i = 0; i < 10; ++i) {
    liar.publish(LyingArray());
  }
  expectDeblurred(recording, testParameters());
}

TEST_F(Live, SurvivesAChangeOfSize) {
  connectTo("/long_timeout");
  RecordingSettings settings = laterSettings();
  settings.frames = 3;
  const Recording small = makeRecording(settings);
  settings.start_ns += 5 * kNanosecondsPerSecond;
  settings.size = {64, 56};
  const Recording large = makeRecording(settings);
  client_->play(small);
  client_->play(large);
  Recording both = small;
  both.insert(both.end(), large.begin(), large.end());
  const std::vector<Output> outputs = client_->waitForOutputs(6);
  expectOneOutputForEachFrame(both, outputs);
  expectSameImages(outputs, deblurWithoutRos(both, testParameters()));
}

TEST_F(Live, PassesFramesOfAnotherSizeThanTheSensorsThrough) {
  connectTo("/quick");
  RecordingSettings settings = laterSettings();
  settings.frames = 3;
  Recording recording = makeRecording(settings);
  settings.size = {64, 56};
  const std::vector<sensor_msgs::ImageConstPtr> larger = imagesOf(makeRecording(settings));
  std::size_t next = 0;
  for (Arrival& arrival : recording) {
    if (arrival.image) {
      arrival.image = larger.at(next++);
    } else if (arrival.info) {
      auto changed = boost::make_shared<sensor_msgs::CameraInfo>(*arrival.info);
      changed->height = 56;
      arrival.info = changed;
    }
  }
  client_->play(recording);
  const std::vector<Output> outputs = client_->waitForOutputs(3);
  expectOneOutputForEachFrame(recording, outputs);
  EXPECT_EQ(countChanged(recording, outputs), 0);
  EXPECT_TRUE(client_->waitForReport([](const DiagnosticStatus& status) {
    return valueOf(status, "Frames passed through: size differs from the event sensor") != "0";
  })) << client_->report().message;
}

TEST_F(Live, SubscribesOnlyWhileSomebodyListens) {
  connectTo("/quick");
  ASSERT_TRUE(client_->stopListening());
  EXPECT_TRUE(client_->waitForReport([](const DiagnosticStatus& status) {
    return status.level == DiagnosticStatus::OK && contains(status.message, "idle");
  })) << client_->report().message;
  EXPECT_FALSE(client_->anyInputConnected());
  ASSERT_TRUE(client_->listen());
}

TEST_F(Live, ShowsSilence) {
  connectTo("/quick");
  EXPECT_TRUE(client_->waitForReport([](const DiagnosticStatus& status) {
    return status.level == DiagnosticStatus::ERROR &&
           contains(status.message, "no frame on /quick/image_raw");
  })) << client_->report().message;
}

TEST_F(Live, DrawsAComparisonForWhoeverSubscribes) {
  connectTo("/long_timeout");
  std::mutex mutex;
  std::condition_variable changed;
  sensor_msgs::ImageConstPtr picture;
  const ros::Subscriber subscriber = client_->nodeHandle().subscribe<sensor_msgs::Image>(
      "comparison", 10, [&](const sensor_msgs::ImageConstPtr& image) {
        const std::lock_guard<std::mutex> lock(mutex);
        picture = image;
        changed.notify_all();
      });
  ASSERT_TRUE(waitUntil([] { return publisherSendsToUs("/long_timeout/comparison"); }));
  RecordingSettings settings = laterSettings();
  settings.frames = 3;
  client_->play(makeRecording(settings));
  std::unique_lock<std::mutex> lock(mutex);
  ASSERT_TRUE(changed.wait_for(lock, kDeadline, [&] { return picture != nullptr; }));
  EXPECT_EQ(picture->encoding, "bgr8");
  EXPECT_EQ(picture->width, 3u * 64u);
  EXPECT_EQ(picture->height, 48u);
}

TEST_F(Live, FilmsWhatIsBetweenTheFramesForWhoeverSubscribes) {
  client_ = std::make_unique<NodeClient>("/filmed", "/filmed/deblur");
  std::mutex mutex;
  std::condition_variable changed;
  std::vector<sensor_msgs::ImageConstPtr> images;
  ros::Subscriber subscriber = client_->nodeHandle().subscribe<sensor_msgs::Image>(
      "latent/image_raw", 1000, [&](const sensor_msgs::ImageConstPtr& image) {
        const std::lock_guard<std::mutex> lock(mutex);
        images.push_back(image);
        changed.notify_all();
      });
  ASSERT_TRUE(waitUntil([this] {
    return client_->allInputsConnected() && publisherSendsToUs("/filmed/latent/image_raw");
  })) << "nobody but the film's viewer keeps the inputs subscribed";
  RecordingSettings settings = laterSettings();
  settings.frames = 3;
  const Recording recording = makeRecording(settings);
  client_->play(recording);

  // Four in each exposure, and in each of the gaps, which are longer.
  std::vector<std::int64_t> expected_ns;
  constexpr std::int64_t kImages = 4;
  const auto expect = [&expected_ns](std::int64_t start_ns, std::int64_t length_ns) {
    for (std::int64_t i = 0; i < kImages; ++i) {
      expected_ns.push_back(start_ns + length_ns * (2 * i + 1) / (2 * kImages));
    }
  };
  const std::int64_t gap_ns = settings.frame_period_ns - settings.exposure_ns;
  for (int frame = 0; frame < settings.frames; ++frame) {
    const std::int64_t start_ns =
        settings.start_ns + settings.first_exposure_ns + frame * settings.frame_period_ns;
    if (frame > 0) {
      expect(start_ns - gap_ns, gap_ns);
    }
    expect(start_ns, settings.exposure_ns);
  }
  {
    std::unique_lock<std::mutex> lock(mutex);
    ASSERT_TRUE(
        changed.wait_for(lock, kDeadline, [&] { return images.size() >= expected_ns.size(); }));
    ASSERT_EQ(images.size(), expected_ns.size());
    for (std::size_t i = 0; i < images.size(); ++i) {
      EXPECT_EQ(static_cast<std::int64_t>(images[i]->header.stamp.toNSec()), expected_ns[i]) << i;
      EXPECT_EQ(images[i]->header.frame_id, "camera");
      EXPECT_EQ(images[i]->encoding, "mono8");
      EXPECT_EQ(images[i]->width, 64u);
    }
  }
  subscriber.shutdown();
  EXPECT_TRUE(waitUntil([this] { return !client_->anyInputConnected(); }));
  client_.reset();
}

TEST_F(Live, SendsAZeroCalibrationWhenItHasNone) {
  connectTo("/biased");  // no other test sends a camera_info there
  RecordingSettings settings = laterSettings();
  settings.camera_info = false;
  settings.frames = 2;
  const Recording recording = makeRecording(settings);
  client_->play(recording);
  const std::vector<Output> outputs = client_->waitForOutputs(2);
  expectOneOutputForEachFrame(recording, outputs);
  EXPECT_EQ(outputs.at(0).info->K[0], 0.0);
}

TEST_F(Live, FollowsTheDriversBiases) {
  connectTo("/biased");
  ros::Publisher updates =
      client_->nodeHandle().advertise<dynamic_reconfigure::Config>("bias_updates", 1, true);
  dynamic_reconfigure::Config update;
  const auto set = [&update](const char* name, int value) {
    dynamic_reconfigure::IntParameter parameter;
    parameter.name = name;
    parameter.value = value;
    update.ints.push_back(parameter);
  };
  set("DiffBn_coarse", 4);
  set("DiffBn_fine", 39);
  set("ONBn_coarse", 6);
  set("ONBn_fine", 200);
  set("OFFBn_coarse", 4);
  set("OFFBn_fine", 1);
  updates.publish(update);
  const auto follows = [](const DiagnosticStatus& status, const char* off) {
    return valueOf(status, "Contrast threshold ON").substr(0, 6) == "0.3819" &&
           valueOf(status, "Contrast threshold OFF").substr(0, 6) == off;
  };
  EXPECT_TRUE(client_->waitForReport([&](const DiagnosticStatus& status) {
    return follows(status, "0.2415");
  })) << valueOf(client_->report(), "Contrast threshold ON");
  update.ints.back().value = 0;  // as the stock driver has it
  updates.publish(update);
  EXPECT_TRUE(client_->waitForReport([&](const DiagnosticStatus& status) {
    return follows(status, "0.3819") &&
           contains(valueOf(status, "Contrast from"), "OFF assumed to be as ON");
  })) << valueOf(client_->report(), "Contrast from");
  update.ints.at(1).value = 0;  // DiffBn without current: there is nothing to compare with
  updates.publish(update);
  EXPECT_TRUE(client_->waitForReport([&](const DiagnosticStatus& status) {
    return contains(status.message, "/biased/bias_updates refused") && follows(status, "0.3819");
  })) << client_->report().message;
}

}  // namespace
}  // namespace test
}  // namespace fast_edi

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "deblur_live");
  const ros::NodeHandle keeps_ros_running;
  return RUN_ALL_TESTS();
}
