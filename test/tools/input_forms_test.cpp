/// The same recording in other forms: split over bags, its frames compressed, frames written out.
#include <gmock/gmock.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/CompressedImage.h>
#include <sensor_msgs/Image.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <opencv2/imgcodecs.hpp>

#include "fast_edi/bags/bag_reader.hpp"
#include "fast_edi/bags/bag_writer.hpp"
#include "fast_edi/events/event_wire.hpp"
#include "rostest/recording.hpp"
#include "support/command.hpp"
#include "support/temporary_directory.hpp"

namespace fast_edi {
namespace {

using testing::CommandResult;
using ::testing::HasSubstr;
using testing::runCommand;
using ::testing::SizeIs;

const std::string kTools = std::string(FAST_EDI_TOOLS_DIR) + "/";
const std::string kThresholds = " contrast_threshold_on:=0.3 contrast_threshold_off:=0.25";
constexpr int kFrames = 4;

std::vector<sensor_msgs::Image> imagesOn(const std::string& path, const std::string& topic) {
  std::vector<sensor_msgs::Image> images;
  const rosbag::Bag bag(path);
  for (const rosbag::MessageInstance& message : rosbag::View(bag, rosbag::TopicQuery(topic))) {
    images.push_back(*message.instantiate<sensor_msgs::Image>());
    images.back().header.seq = 0;  // of the recording's publisher
  }
  return images;
}

class InputForms : public ::testing::Test {
 protected:
  void SetUp() override {
    test::RecordingSettings settings;
    settings.frames = kFrames;
    recording_ = test::makeRecording(settings);
    test::writeBag(recording_, "/dvs", bag_);
    const CommandResult result = runCommand(kTools + "deblur_bag --in " + bag_ + " --out " +
                                            file("plain.bag") + kThresholds);
    ASSERT_EQ(result.exit_code, 0) << result.output;
    expected_ = imagesOn(file("plain.bag"), "/dvs/deblurred/image_raw");
    ASSERT_THAT(expected_, SizeIs(kFrames));
  }

  std::string file(const std::string& name) const { return directory_.file(name); }

  const TemporaryDirectory directory_;
  const std::string bag_ = file("in.bag");
  test::Recording recording_;
  std::vector<sensor_msgs::Image> expected_;
};

TEST_F(InputForms, SeveralBagsInARow) {
  {
    BagReader reader(bag_);
    BagWriter first(file("a_0.bag"), {bag_}, "none", false);
    BagWriter second(file("a_1.bag"), {bag_}, "none", false);
    BagMessage message;
    while (reader.next(message)) {
      (reader.position() <= reader.length() / 2 ? first : second).copy(message);
    }
    first.close();
    second.close();
  }
  const std::string parts = file("a_1.bag") + " " + file("a_0.bag");
  CommandResult result = runCommand(kTools + "deblur_bag --in " + parts + kThresholds + " --out " +
                                    file("joined.bag"));
  ASSERT_EQ(result.exit_code, 0) << result.output;
  EXPECT_EQ(imagesOn(file("joined.bag"), "/dvs/deblurred/image_raw"), expected_);
  EXPECT_THAT(imagesOn(file("joined.bag"), "/dvs/image_raw"), SizeIs(kFrames));
  result = runCommand(kTools + "convert_recording " + parts + " " + file("joined.aedat4"));
  ASSERT_EQ(result.exit_code, 0) << result.output;
  EXPECT_THAT(result.output, HasSubstr(" 4 frames, 4 of them with their exposure"));
  result = runCommand(kTools + "count_tags " + parts + kThresholds);
  EXPECT_EQ(result.exit_code, 0) << result.output;
  EXPECT_THAT(result.output, HasSubstr("4 frames deblurred of 4"));
  result = runCommand(kTools + "deblur_bag --in " + parts + kThresholds + " --force --out " +
                      file("a_0.bag"));
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.output, HasSubstr("it is the input"));
}

TEST_F(InputForms, AConversionThatWasKilledIsNotOverwrittenByItsOwn) {
  const std::string killed = file("killed.aedat4");
  ASSERT_EQ(runCommand(kTools + "convert_recording " + bag_ + " " + killed).exit_code, 0);
  std::filesystem::rename(killed, killed + ".active");
  const auto size = std::filesystem::file_size(killed + ".active");
  const CommandResult result =
      runCommand(kTools + "convert_recording --force " + killed + ".active " + killed);
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.output, HasSubstr("it is the input"));
  EXPECT_EQ(std::filesystem::file_size(killed + ".active"), size);
}

TEST_F(InputForms, CompressedFrames) {
  {
    const rosbag::Bag bag(bag_);
    rosbag::Bag compressed(file("compressed.bag"), rosbag::bagmode::Write);
    for (const rosbag::MessageInstance& message : rosbag::View(bag)) {
      const auto image = message.instantiate<sensor_msgs::Image>();
      if (!image) {
        compressed.write(message.getTopic(), message.getTime(), message);
        continue;
      }
      sensor_msgs::CompressedImage frame;
      frame.header = image->header;
      frame.format = image->encoding + "; png compressed ";
      const cv::Mat pixels(static_cast<int>(image->height), static_cast<int>(image->width), CV_8UC1,
                           image->data.data(), image->step);
      cv::imencode(".png", pixels, frame.data);
      compressed.write("/dvs/image_raw/compressed", message.getTime(), frame);
    }
  }
  const std::string in = file("compressed.bag");
  CommandResult result =
      runCommand(kTools + "deblur_bag --in " + in + kThresholds + " --out " + file("out.bag"));
  ASSERT_EQ(result.exit_code, 0) << result.output;
  EXPECT_EQ(imagesOn(file("out.bag"), "/dvs/deblurred/image_raw"), expected_);
  EXPECT_THAT(imagesOn(file("out.bag"), "/dvs/image_raw"), SizeIs(0)) << "only what was recorded";
  result = runCommand(kTools + "convert_recording " + in + " " + file("raw.bag"));
  ASSERT_EQ(result.exit_code, 0) << result.output;
  EXPECT_EQ(imagesOn(file("raw.bag"), "/dvs/image_raw"), imagesOn(bag_, "/dvs/image_raw"));
}

TEST_F(InputForms, PicturesAndText) {
  std::filesystem::create_directories(file("evdi/Blur"));
  {
    std::ofstream events(file("evdi/Events.txt"));
    std::ofstream starts(file("evdi/Exposure_start.txt"));
    std::ofstream ends(file("evdi/Exposure_end.txt"));
    int frames = 0;
    for (const test::Arrival& arrival : recording_) {
      if (arrival.events) {
        const WireEvents wire = arrival.events->events();
        for (std::size_t i = 0; i < wire.count; ++i) {
          const Event event = decodeWireEvent(wire.record(i));
          events << event.t_ns << " " << event.x << " " << event.y << " " << event.on << "\n";
        }
      }
      if (arrival.image) {
        const sensor_msgs::Image& image = *arrival.image;
        const std::uint64_t stamp_ns = image.header.stamp.toNSec();
        starts << stamp_ns - 5'000'000 << "\n";
        ends << stamp_ns + 5'000'000 << "\n";
        const cv::Mat pixels(static_cast<int>(image.height), static_cast<int>(image.width), CV_8UC1,
                             const_cast<std::uint8_t*>(image.data.data()), image.step);
        cv::imwrite(file("evdi/Blur/" + std::to_string(frames++) + ".png"), pixels);
      }
    }
  }
  const CommandResult packed =
      runCommand("cd " + file("evdi") + " && python3 -m zipfile -c ../evdi.zip *");
  ASSERT_EQ(packed.exit_code, 0) << packed.output;
  for (const char* name : {"evdi", "evdi.zip"}) {
    const CommandResult result = runCommand(kTools + "deblur_bag --in " + file(name) + kThresholds +
                                            " --force --out " + file("evdi.bag"));
    ASSERT_EQ(result.exit_code, 0) << result.output;
    const std::vector<sensor_msgs::Image> frames =
        imagesOn(file("evdi.bag"), "/dvs/deblurred/image_raw");
    ASSERT_THAT(frames, SizeIs(kFrames)) << name;
    for (std::size_t i = 0; i < frames.size(); ++i) {
      EXPECT_EQ(frames[i].header.stamp, expected_[i].header.stamp) << name;
      EXPECT_EQ(frames[i].data, expected_[i].data) << name;
    }
  }
}

TEST_F(InputForms, SimulatedInOtherFormats) {
  const std::string simulate = kTools + "simulate_davis --frames 3 --width 64 --height 48 --out ";
  for (const char* arguments :
       {"s.bag", "s.aedat4 --compression zstd", "s.h5", "s.hdf5 --compression gzip"}) {
    const CommandResult result = runCommand(simulate + file(arguments));
    ASSERT_EQ(result.exit_code, 0) << result.output;
  }
  EXPECT_FALSE(std::filesystem::exists(file("s.aedat4.bag")));
  EXPECT_FALSE(std::filesystem::exists(file("s.h5.bag")));
  for (const char* name : {"s.bag", "s.aedat4", "s.h5", "s.hdf5"}) {
    const CommandResult result = runCommand(kTools + "deblur_bag --in " + file(name) + kThresholds +
                                            " --out " + file(name) + ".out");
    ASSERT_EQ(result.exit_code, 0) << result.output;
  }
  const auto of_bag = imagesOn(file("s.bag.out"), "/dvs/deblurred/image_raw");
  ASSERT_THAT(of_bag, SizeIs(3));
  for (const char* name : {"s.aedat4.out", "s.h5.out", "s.hdf5.out"}) {
    const auto of_other = imagesOn(file(name), "/dvs/deblurred/image_raw");
    ASSERT_THAT(of_other, SizeIs(3)) << name;
    for (std::size_t i = 0; i < of_bag.size(); ++i) {
      EXPECT_EQ(of_other[i].header.stamp, of_bag[i].header.stamp) << name;
      EXPECT_EQ(of_other[i].data, of_bag[i].data) << name;
    }
  }
  EXPECT_THAT(runCommand(simulate + file("x.h5 --compression lz4")).output,
              HasSubstr("--compression lz4: expected none or gzip for HDF5"));
}

TEST_F(InputForms, OtherToolsTakeHdf5) {
  CommandResult result =
      runCommand(kTools + "convert_recording " + bag_ + " " + file("r.h5") + " --compression none");
  ASSERT_EQ(result.exit_code, 0) << result.output;
  EXPECT_THAT(result.output, HasSubstr(" 4 frames, 4 of them with their exposure"));
  result = runCommand(kTools + "count_tags " + file("r.h5") + kThresholds);
  EXPECT_EQ(result.exit_code, 0) << result.output;
  EXPECT_THAT(result.output, HasSubstr("4 frames deblurred of 4"));
  result = runCommand(kTools + "validate_bag " + file("r.h5") + kThresholds);
  EXPECT_NE(result.exit_code, 1) << result.output;
  result = runCommand(kTools + "convert_recording " + file("r.h5") + " " + file("again.bag"));
  ASSERT_EQ(result.exit_code, 0) << result.output;
  const auto frames = imagesOn(file("again.bag"), "/dvs/image_raw");
  const auto recorded = imagesOn(bag_, "/dvs/image_raw");
  ASSERT_THAT(frames, SizeIs(kFrames));
  for (std::size_t i = 0; i < frames.size(); ++i) {
    EXPECT_EQ(frames[i].header.stamp, recorded[i].header.stamp);
    EXPECT_EQ(frames[i].data, recorded[i].data);
  }
}

TEST_F(InputForms, SaysWhatIsMissing) {
  std::filesystem::create_directories(file("folder"));
  CommandResult result = runCommand(kTools + "deblur_bag --in " + file("folder") + kThresholds +
                                    " --out " + file("x.bag"));
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.output, HasSubstr("nor is it a folder with images.txt"));
  const std::string path = file("events.aedat");
  std::ofstream(path, std::ios::binary)
      << "#!AER-DAT2.0\r\n# AEChip: eu.seebetter.ini.chips.davis.DAVIS240C\r\n"
      << std::string("\0\0\x8\0\0\0\0\x1", 8);
  result = runCommand(kTools + "deblur_bag --in " + path + kThresholds + " --out " + file("y.bag"));
  EXPECT_EQ(result.exit_code, 3) << result.output;
  EXPECT_THAT(result.output, HasSubstr("has no frames on /dvs/image_raw: nothing was deblurred"));
}

TEST_F(InputForms, FramesComeAsPictures) {
  const CommandResult result =
      runCommand(kTools + "deblur_bag --in " + bag_ + kThresholds + " --frames " + file("frames"));
  ASSERT_EQ(result.exit_code, 0) << result.output;
  std::ifstream list(file("frames/frames.csv"));
  std::string line;
  std::getline(list, line);
  EXPECT_EQ(line, "index,file,stamp_ns,exposure_start_ns,exposure_end_ns");
  for (int i = 0; i < kFrames; ++i) {
    const sensor_msgs::Image& frame = expected_[static_cast<std::size_t>(i)];
    const std::uint64_t stamp_ns = frame.header.stamp.toNSec();
    std::getline(list, line);
    EXPECT_EQ(line, std::to_string(i) + ",00000" + std::to_string(i) + ".png," +
                        std::to_string(stamp_ns) + "," + std::to_string(stamp_ns - 5'000'000) +
                        "," + std::to_string(stamp_ns + 5'000'000));
    const cv::Mat pixels =
        cv::imread(file("frames/00000" + std::to_string(i) + ".png"), cv::IMREAD_UNCHANGED);
    ASSERT_EQ(pixels.type(), CV_8UC1);
    EXPECT_EQ(std::vector<std::uint8_t>(pixels.datastart, pixels.dataend), frame.data);
  }
  const CommandResult again =
      runCommand(kTools + "deblur_bag --in " + bag_ + kThresholds + " --frames " + file("frames"));
  EXPECT_EQ(again.exit_code, 1);
  EXPECT_THAT(again.output, HasSubstr("the folder is not empty (--force writes into it)"));
}

TEST_F(InputForms, MapsOfTrustComeAsPictures) {
  const std::string command = kTools + "deblur_bag --in " + bag_ + kThresholds + " --trust ";
  const CommandResult refused = runCommand(command + file("none") + " filter_reblur:=false");
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.output, HasSubstr("--trust needs filter_reblur:=true"));
  const CommandResult result = runCommand(command + file("trust"));
  ASSERT_EQ(result.exit_code, 0) << result.output;
  EXPECT_THAT(result.output, HasSubstr("maps of trust to"));
  for (int i = 0; i < kFrames; ++i) {
    const sensor_msgs::Image& frame = expected_[static_cast<std::size_t>(i)];
    const cv::Mat pixels =
        cv::imread(file("trust/00000" + std::to_string(i) + ".png"), cv::IMREAD_UNCHANGED);
    ASSERT_EQ(pixels.type(), CV_8UC1);
    EXPECT_EQ(pixels.cols, static_cast<int>(frame.width));
    EXPECT_EQ(pixels.rows, static_cast<int>(frame.height));
    EXPECT_EQ(cv::countNonZero(pixels), 0) << "events at random, which no motion explains";
  }
}

}  // namespace
}  // namespace fast_edi
