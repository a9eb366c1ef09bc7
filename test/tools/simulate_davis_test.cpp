/// The program `simulate_davis`, run as a user runs it, and the demo recording it made.
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <std_msgs/Int32.h>

#include "fast_edi/events/event_wire.hpp"
#include "fast_edi/messages/event_array.hpp"
#include "support/command.hpp"
#include "support/temporary_directory.hpp"

namespace fast_edi {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Pair;

const std::string kTool = std::string(FAST_EDI_TOOLS_DIR) + "/simulate_davis ";
constexpr std::int64_t kStartNs = 1'700'000'000 * kNanosecondsPerSecond;

struct Recorded {
  std::int64_t time_ns;  ///< record time
  std::string topic;
  std::string type;
};

/// A bag, message by message in record-time order.
struct Recording {
  std::vector<Recorded> messages;
  std::map<std::string, int> counts;
  std::vector<sensor_msgs::Image> images;
  std::vector<sensor_msgs::Image> truths;
  std::vector<int> exposures_us;
  std::vector<sensor_msgs::CameraInfo> camera_infos;
  std::vector<EventArray> arrays;
  std::vector<std::int64_t> array_times_ns;
};

Recording readBag(const std::string& path, const std::string& name_space = "/dvs") {
  Recording recording;
  const rosbag::Bag bag(path);
  for (const rosbag::MessageInstance& message : rosbag::View(bag)) {
    const std::string& topic = message.getTopic();
    const auto time_ns = static_cast<std::int64_t>(message.getTime().toNSec());
    recording.messages.push_back({time_ns, topic, message.getDataType()});
    ++recording.counts[topic];
    if (topic == name_space + "/image_raw") {
      recording.images.push_back(*message.instantiate<sensor_msgs::Image>());
    } else if (topic == name_space + "/ground_truth/image_raw") {
      recording.truths.push_back(*message.instantiate<sensor_msgs::Image>());
    } else if (topic == name_space + "/exposure") {
      recording.exposures_us.push_back(message.instantiate<std_msgs::Int32>()->data);
    } else if (topic == name_space + "/camera_info") {
      recording.camera_infos.push_back(*message.instantiate<sensor_msgs::CameraInfo>());
    } else if (topic == name_space + "/events") {
      recording.arrays.push_back(*message.instantiate<EventArray>());
      recording.array_times_ns.push_back(time_ns);
    }
  }
  return recording;
}

std::string bytesOf(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::int64_t stampNs(const std_msgs::Header& header) {
  return static_cast<std::int64_t>(header.stamp.toNSec());
}

class SimulateDavisTool : public ::testing::Test {
 protected:
  /// Three frames of 9999 us every 20 ms; the first exposure begins 20 ms after the start.
  testing::CommandResult simulate(const std::string& options, const std::string& name = "a.bag") {
    return testing::runCommand(kTool + "--out " + directory_.file(name) +
                               " --sensor davis240c --frames 3 --period-us 20000"
                               " --exposure-us 9999 --motion mild --density 0.2 " +
                               options);
  }
  std::string path(const std::string& name = "a.bag") const { return directory_.file(name); }

 private:
  TemporaryDirectory directory_;
};

TEST_F(SimulateDavisTool, WritesABagOfTheDriversShape) {
  const auto result = simulate("");
  ASSERT_EQ(result.exit_code, 0) << result.output;
  EXPECT_THAT(result.output, HasSubstr("a.bag: 3 frames, "));
  const Recording bag = readBag(path());

  const int arrays = static_cast<int>(bag.arrays.size());
  EXPECT_THAT(bag.counts,
              ElementsAre(Pair("/dvs/camera_info", arrays), Pair("/dvs/events", arrays),
                          Pair("/dvs/exposure", 3), Pair("/dvs/ground_truth/image_raw", 3),
                          Pair("/dvs/image_raw", 3)));
  for (std::size_t i = 1; i < bag.messages.size(); ++i) {
    EXPECT_GE(bag.messages[i].time_ns, bag.messages[i - 1].time_ns);
  }
  EXPECT_THAT(bag.exposures_us, ElementsAre(9999, 9999, 9999));

  ASSERT_EQ(bag.images.size(), 3U);
  for (std::size_t i = 0; i < bag.images.size(); ++i) {
    const sensor_msgs::Image& image = bag.images[i];
    // start = stamp - floor(L / 2) us.
    const std::int64_t start_ns =
        kStartNs + (20'000 + 20'000 * static_cast<std::int64_t>(i)) * kNanosecondsPerMicrosecond;
    EXPECT_EQ(stampNs(image.header) / 1000 - 9999 / 2, start_ns / 1000);
    EXPECT_EQ(bag.truths[i].header.stamp, image.header.stamp);
    for (const sensor_msgs::Image* each : {&image, &bag.truths[i]}) {
      EXPECT_EQ(each->header.frame_id, "");
      EXPECT_EQ(each->encoding, "mono8");
      EXPECT_EQ(each->width, 240U);
      EXPECT_EQ(each->height, 180U);
      EXPECT_EQ(each->step, 240U);
      EXPECT_EQ(each->data.size(), 240U * 180U);
    }
  }
  for (const sensor_msgs::CameraInfo& info : bag.camera_infos) {
    EXPECT_TRUE(info.header.stamp.isZero());
    EXPECT_EQ(info.header.frame_id, "");
    EXPECT_EQ(info.width, 240U);
    EXPECT_GT(info.K[0], 0.0);
    EXPECT_DOUBLE_EQ(info.K[2], 119.5);
  }
}

TEST_F(SimulateDavisTool, FramesComeAfterTheirExposureAndExposureTimesAfterTheirFrame) {
  ASSERT_EQ(simulate("").exit_code, 0);
  const Recording bag = readBag(path());
  std::int64_t exposure_end_ns = kStartNs + 29'999'000;
  bool exposure_due = false;
  for (const Recorded& message : bag.messages) {
    if (message.topic == "/dvs/image_raw") {
      EXPECT_FALSE(exposure_due);
      EXPECT_GT(message.time_ns, exposure_end_ns + kNanosecondsPerMillisecond);
      EXPECT_LT(message.time_ns, exposure_end_ns + 10 * kNanosecondsPerMillisecond);
      exposure_end_ns += 20 * kNanosecondsPerMillisecond;
      exposure_due = true;
    } else if (message.topic == "/dvs/exposure") {
      EXPECT_TRUE(exposure_due);
      exposure_due = false;
    }
  }
  EXPECT_FALSE(exposure_due);
}

TEST_F(SimulateDavisTool, EventArraysHoldSortedEventsOfTheirStretchOfTime) {
  ASSERT_EQ(simulate("--array-us 3000").exit_code, 0);
  const Recording bag = readBag(path());
  std::int64_t last_ns = kStartNs;
  std::uint32_t sequence = 0;
  for (std::size_t i = 0; i < bag.arrays.size(); ++i) {
    const EventArray& array = bag.arrays[i];
    EXPECT_EQ(array.header.seq, sequence++);
    EXPECT_EQ(sensorSize(array), (SensorSize{240, 180}));
    const WireEvents events = array.events();
    ASSERT_GT(events.count, 0U);
    const std::int64_t stretch = (decodeWireEvent(events.record(0)).t_ns - kStartNs) / 3'000'000;
    for (std::size_t k = 0; k < events.count; ++k) {
      const Event event = decodeWireEvent(events.record(k));
      ASSERT_GE(event.t_ns, last_ns);
      ASSERT_EQ((event.t_ns - kStartNs) / 3'000'000, stretch);
      ASSERT_EQ(event.t_ns % kNanosecondsPerMicrosecond, 0);
      ASSERT_LT(event.x, 240);
      ASSERT_LT(event.y, 180);
      last_ns = event.t_ns;
    }
    EXPECT_GT(bag.array_times_ns[i], last_ns);
  }
  // Events go on after the last exposure, so that its frame can be closed.
  EXPECT_GT(last_ns, kStartNs + (20'000 + 2 * 20'000 + 9999) * kNanosecondsPerMicrosecond);
}

TEST_F(SimulateDavisTool, StillSceneWithoutNoiseHasNoArrays) {
  ASSERT_EQ(testing::runCommand(kTool + "--out " + path() +
                                " --sensor davis240c --frames 2 --motion still --noise none")
                .exit_code,
            0);
  const Recording bag = readBag(path());
  EXPECT_TRUE(bag.arrays.empty());
  EXPECT_EQ(bag.images.size(), 2U);
}

TEST_F(SimulateDavisTool, TopicsAndStampsFollowTheOptions) {
  ASSERT_EQ(simulate("--no-exposure --no-camera-info --no-ground-truth --stamp start "
                     "--namespace /davis")
                .exit_code,
            0);
  const Recording bag = readBag(path(), "/davis");
  EXPECT_THAT(bag.counts, ElementsAre(Pair("/davis/events", static_cast<int>(bag.arrays.size())),
                                      Pair("/davis/image_raw", 3)));
  EXPECT_EQ(stampNs(bag.images[1].header), kStartNs + 40 * kNanosecondsPerMillisecond);
}

TEST_F(SimulateDavisTool, EncodingsHaveTheirLayout) {
  const std::map<std::string, unsigned> bytes_per_pixel{
      {"mono16", 2}, {"bayer_rggb8", 1}, {"rgb8", 3}, {"bgr8", 3}};
  for (const auto& [encoding, bytes] : bytes_per_pixel) {
    ASSERT_EQ(simulate("--encoding " + encoding, encoding).exit_code, 0) << encoding;
    const Recording bag = readBag(path(encoding));
    EXPECT_EQ(bag.images[0].encoding, encoding);
    EXPECT_EQ(bag.images[0].step, 240 * bytes);
    EXPECT_EQ(bag.images[0].data.size(), std::size_t{240} * bytes * 180);
    EXPECT_EQ(bag.truths[0].encoding, encoding);
  }
  // The same scene with its channels the other way round.
  const Recording rgb = readBag(path("rgb8"));
  const Recording bgr = readBag(path("bgr8"));
  const std::vector<std::uint8_t>& a = rgb.truths[0].data;
  const std::vector<std::uint8_t>& b = bgr.truths[0].data;
  double red = 0.0;
  double blue = 0.0;
  for (std::size_t i = 0; i + 2 < a.size(); i += 3) {
    ASSERT_EQ(a[i], b[i + 2]);
    red += a[i];
    blue += a[i + 2];
  }
  EXPECT_GT(red, blue) << "the wall is reddish";
}

TEST_F(SimulateDavisTool, EqualCommandsGiveEqualBytes) {
  ASSERT_EQ(simulate("--compression bz2 --tags 2", "a.bag").exit_code, 0);
  ASSERT_EQ(simulate("--compression bz2 --tags 2", "b.bag").exit_code, 0);
  ASSERT_EQ(simulate("--compression bz2 --tags 2 --seed 2", "c.bag").exit_code, 0);
  EXPECT_EQ(bytesOf(path("a.bag")), bytesOf(path("b.bag")));
  EXPECT_NE(bytesOf(path("a.bag")), bytesOf(path("c.bag")));
}

TEST_F(SimulateDavisTool, RefusesWhatItCannotDo) {
  const std::vector<std::pair<std::string, std::string>> cases{
      {"--encoding yuv422", "--encoding: expected mono8, mono16"},
      {"--stamp noon", "--stamp: expected start, mid or end, got \"noon\""},
      {"--noise loud", "--noise: sensor model: expected one of none, clean"},
      {"--texture velvet",
       "texture: expected one of poster, natural, flat, mosaic, page, clouds, facade, weave, got "
       "\"velvet\""},
      {"--threshold-on 0", "ON threshold [natural log]: expected 0.01 to 10, got 0"},
      {"--array-us 0", "--array-us: expected more than 0"},
      {"--frmes 3", "unrecognised option '--frmes'"},
      {"--tags many", "many"}};
  for (const auto& [options, message] : cases) {
    const auto result = simulate(options);
    EXPECT_EQ(result.exit_code, 1) << options;
    EXPECT_THAT(result.output, HasSubstr(message)) << options;
    EXPECT_FALSE(std::filesystem::exists(path())) << options;
  }
  const auto no_picture = simulate("--texture ./missing.png");
  EXPECT_EQ(no_picture.exit_code, 1);
  EXPECT_THAT(no_picture.output, HasSubstr("./missing.png: expected a picture"));
}

TEST_F(SimulateDavisTool, KeepsAnExistingBagUnlessTold) {
  ASSERT_EQ(simulate("").exit_code, 0);
  const std::string before = bytesOf(path());
  const auto again = simulate("--seed 2");
  EXPECT_EQ(again.exit_code, 1);
  EXPECT_THAT(again.output, HasSubstr(path()));
  EXPECT_EQ(bytesOf(path()), before);
  ASSERT_EQ(simulate("--seed 2 --force").exit_code, 0);
  EXPECT_NE(bytesOf(path()), before);
  ASSERT_EQ(simulate("--overwrite").exit_code, 0) << "the old name of --force";
  EXPECT_EQ(bytesOf(path()), before);
}

TEST_F(SimulateDavisTool, ExplainsItselfWithUnits) {
  const auto help = testing::runCommand(kTool + "--help");
  EXPECT_EQ(help.exit_code, 0);
  for (const char* text :
       {"--exposure-us X", "[us]", "[Hz]", "[px]", "[natural log]", "--tags X"}) {
    EXPECT_THAT(help.output, HasSubstr(text));
  }
}

TEST(DemoBag, IsSmallWholeAndOfTheDriversShape) {
  const std::string path = std::string(FAST_EDI_SOURCE_DIR) + "/bags/demo.bag";
  EXPECT_LT(std::filesystem::file_size(path), 10'000'000U);
  const Recording bag = readBag(path);
  EXPECT_EQ(bag.images.size(), 30U);
  EXPECT_EQ(bag.truths.size(), 30U);
  EXPECT_EQ(bag.exposures_us, std::vector<int>(30, 30'000));
  std::size_t events = 0;
  for (const EventArray& array : bag.arrays) events += array.events().count;
  EXPECT_EQ(events, 1'449'825U);
}

}  // namespace
}  // namespace fast_edi
