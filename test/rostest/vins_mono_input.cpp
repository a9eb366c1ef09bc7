// What VINS-Mono needs of its image topic: raw mono8 frames, never a duplicate or an older stamp,
// never a gap above 1 s (each of which restarts its estimator), whatever happens to frames, events
// and exposures on their way. Plays bags through the nodelet, see vins_mono_input.test.

#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <ros/init.h>
#include <boost/make_shared.hpp>

#include "rostest/child_process.hpp"
#include "rostest/node_client.hpp"
#include "rostest/recording.hpp"
#include "support/temporary_directory.hpp"

namespace fast_edi {
namespace test {
namespace {

/// VINS-Mono's own limit.
const ros::Duration kLargestGap(1.0);

/// Two seconds of a DAVIS at 25 Hz in trouble; each fault is alone in its part of the recording.
class TroubledRecording {
 public:
  explicit TroubledRecording(std::int64_t start_ns) {
    settings_.start_ns = start_ns;
    settings_.frames = 50;
    recording_ = makeRecording(settings_);
    removeEvents(0.0, 0.25);    // the stream starts late
    removeExposures(0.4, 0.6);  // lost on their way
    removeEvents(0.7, 0.75);    // two arrays lost: a gap in header.seq
    silenceEvents(0.9, 1.3);    // a still scene: no array at all, and no number lost
    repeatStamp(36);
    stepBack(40);
  }

  const Recording& recording() const { return recording_; }
  /// Frames that cannot have an output: their stamp is that of the frame before, or older.
  static constexpr int kWithoutOutput = 2;

 private:
  std::int64_t at(double seconds) const {
    return settings_.start_ns +
           static_cast<std::int64_t>(seconds * static_cast<double>(kNanosecondsPerSecond));
  }
  template <typename Is>
  void removeWithin(double from_s, double to_s, Is is) {
    recording_.erase(std::remove_if(recording_.begin(), recording_.end(),
                                    [&](const Arrival& arrival) {
                                      return is(arrival) && arrival.time_ns >= at(from_s) &&
                                             arrival.time_ns < at(to_s);
                                    }),
                     recording_.end());
  }
  void removeExposures(double from_s, double to_s) {
    removeWithin(from_s, to_s, [](const Arrival& arrival) { return arrival.exposure != nullptr; });
  }
  void removeEvents(double from_s, double to_s) {
    removeWithin(from_s, to_s, [](const Arrival& arrival) { return arrival.events != nullptr; });
  }
  void silenceEvents(double from_s, double to_s) {
    removeEvents(from_s, to_s);
    std::uint32_t seq = 0;
    bool after = false;
    for (Arrival& arrival : recording_) {
      if (!arrival.events) {
        continue;
      }
      after = after || arrival.time_ns >= at(to_s);
      if (after) {
        auto array = boost::make_shared<EventArray>(*arrival.events);
        array->header.seq = seq + 1;
        arrival.events = array;
      }
      seq = arrival.events->header.seq;
    }
  }
  sensor_msgs::ImageConstPtr& imageAt(int index) {
    for (Arrival& arrival : recording_) {
      if (arrival.image && index-- == 0) {
        return arrival.image;
      }
    }
    throw std::out_of_range("no such frame");
  }
  void setStamp(int index, const ros::Time& stamp) {
    auto image = boost::make_shared<sensor_msgs::Image>(*imageAt(index));
    image->header.stamp = stamp;
    imageAt(index) = image;
  }
  void repeatStamp(int index) { setStamp(index, imageAt(index - 1)->header.stamp); }
  void stepBack(int index) {
    setStamp(index, imageAt(index - 2)->header.stamp + ros::Duration(0.001));
  }

  RecordingSettings settings_;
  Recording recording_;
};

/// The rules, for outputs of one run of the clock.
void expectUsable(const std::vector<Output>& outputs) {
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    const sensor_msgs::Image& image = *outputs[i].image;
    EXPECT_EQ(image.encoding, "mono8") << "output " << i;
    EXPECT_EQ(image.width, 64U);
    EXPECT_EQ(image.height, 48U);
    EXPECT_EQ(image.step, image.width);
    EXPECT_EQ(image.data.size(), std::size_t{image.step} * image.height);
    if (i > 0) {
      const ros::Time before = outputs[i - 1].image->header.stamp;
      EXPECT_GT(image.header.stamp, before) << "output " << i;
      EXPECT_LE(image.header.stamp - before, kLargestGap) << "output " << i;
    }
  }
}

/// How many outputs are their input frame, unchanged.
std::size_t countPassedThrough(const Recording& recording, const std::vector<Output>& outputs) {
  const std::vector<sensor_msgs::ImageConstPtr> inputs = imagesOf(recording);
  return static_cast<std::size_t>(
      std::count_if(outputs.begin(), outputs.end(), [&](const Output& output) {
        return std::any_of(inputs.begin(), inputs.end(),
                           [&](const sensor_msgs::ImageConstPtr& input) {
                             return input->data == output.image->data;
                           });
      }));
}

class VinsMonoInput : public ::testing::Test {
 protected:
  void SetUp() override { ASSERT_TRUE(client_.listen()); }
  void play(const std::string& path) {
    ChildProcess player({"rosbag", "play", "--quiet", "--wait-for-subscribers", path});
    EXPECT_EQ(player.wait(), 0);
  }

  TemporaryDirectory directory_;
  NodeClient client_{"/dvs", "/dvs/deblur"};
};

TEST_F(VinsMonoInput, IsUsableWhateverHappens) {
  const TroubledRecording troubled(2'000 * kNanosecondsPerSecond);
  const std::string path = directory_.file("troubled.bag");
  writeBag(troubled.recording(), "/dvs", path);
  play(path);
  const std::size_t expected =
      imagesOf(troubled.recording()).size() - TroubledRecording::kWithoutOutput;
  const std::vector<Output> outputs = client_.waitForOutputs(expected);
  EXPECT_EQ(outputs.size(), expected);
  expectUsable(outputs);
  const std::size_t passed = countPassedThrough(troubled.recording(), outputs);
  EXPECT_GE(passed, 5U) << "too little trouble";
  EXPECT_GE(outputs.size() - passed, 20U) << "too little deblurred";

  // The clock jumps back: VINS-Mono restarts, once, and then finds the same rules kept.
  play(path);
  const std::vector<Output> both = client_.waitForOutputs(2 * expected);
  ASSERT_EQ(both.size(), 2 * expected);
  const std::vector<Output> second(both.begin() + static_cast<std::ptrdiff_t>(expected),
                                   both.end());
  expectUsable(second);
  EXPECT_EQ(second.front().image->header.stamp, outputs.front().image->header.stamp);
}

}  // namespace
}  // namespace test
}  // namespace fast_edi

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "vins_mono_input");
  const ros::NodeHandle keeps_ros_running;
  return RUN_ALL_TESTS();
}
