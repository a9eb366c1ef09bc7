/// The program `deblur_bag`, run as a user runs it.
#include <gmock/gmock.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/Image.h>
#include <std_msgs/String.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <boost/make_shared.hpp>

#include "fast_edi/bags/bag_reader.hpp"
#include "rostest/recording.hpp"
#include "support/command.hpp"
#include "support/temporary_directory.hpp"

namespace fast_edi {
namespace {

namespace fs = std::filesystem;

using ::testing::AllOf;
using ::testing::ContainsRegex;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::SizeIs;

constexpr int kFrames = 10;
const std::string kTool = std::string(FAST_EDI_TOOLS_DIR) + "/deblur_bag ";
const std::string kThresholds = " contrast_threshold_on:=0.3 contrast_threshold_off:=0.25";

struct Raw {
  std::string topic;
  ros::Time time;
  std::string bytes;
  ros::M_string header;

  friend bool operator==(const Raw& a, const Raw& b) {
    return a.topic == b.topic && a.time == b.time && a.bytes == b.bytes && a.header == b.header;
  }
};

std::vector<Raw> readRaw(const std::string& path) {
  std::vector<Raw> all;
  BagReader reader(path);
  BagMessage message;
  while (reader.next(message)) {
    all.push_back({message.connection->topic, message.time,
                   std::string(reinterpret_cast<const char*>(message.data), message.size),
                   *message.connection->header});
  }
  return all;
}

std::vector<Raw> without(const std::vector<Raw>& all, const std::string& prefix) {
  std::vector<Raw> rest;
  for (const Raw& raw : all) {
    if (raw.topic.rfind(prefix, 0) != 0) {
      rest.push_back(raw);
    }
  }
  return rest;
}

std::vector<Raw> on(const std::vector<Raw>& all, const std::string& topic) {
  std::vector<Raw> some;
  for (const Raw& raw : all) {
    if (raw.topic == topic) {
      some.push_back(raw);
    }
  }
  return some;
}

std::string contents(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

void write(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

class DeblurBagTool : public ::testing::Test {
 protected:
  DeblurBagTool() : input_(directory_.file("in.bag")), output_(directory_.file("out.bag")) {
    test::RecordingSettings settings;
    settings.frames = kFrames;
    recording_ = test::makeRecording(settings);
    test::writeBag(recording_, "/dvs", input_);
  }

  testing::CommandResult run(const std::string& arguments) const {
    return testing::runCommand(kTool + arguments);
  }
  std::string paths() const { return "--in '" + input_ + "' --out '" + output_ + "'"; }

  const TemporaryDirectory directory_;
  const std::string input_;
  const std::string output_;
  test::Recording recording_;
};

TEST_F(DeblurBagTool, AddsToACopyWhatThePipelineMakes) {
  const auto result = run(paths() + kThresholds);
  ASSERT_EQ(result.exit_code, 0) << result.output;
  EXPECT_THAT(result.output, AllOf(ContainsRegex(" 10  in\n"), ContainsRegex(" 10  out\n"),
                                   ContainsRegex(" 10  deblurred\n"), HasSubstr("Mev/s")));
  EXPECT_THAT(result.output, Not(HasSubstr("\r"))) << "a progress bar without a terminal";

  const std::vector<Raw> copied = without(readRaw(output_), "/dvs/deblurred/");
  EXPECT_EQ(copied, readRaw(input_));

  const std::vector<test::Output> expected =
      test::deblurWithoutRos(recording_, test::testParameters());
  ASSERT_THAT(expected, SizeIs(kFrames));
  std::vector<sensor_msgs::Image> images;
  std::vector<sensor_msgs::CameraInfo> infos;
  const rosbag::Bag bag(output_);
  for (const rosbag::MessageInstance& message : rosbag::View(bag)) {
    if (message.getTopic() == "/dvs/deblurred/image_raw") {
      images.push_back(*message.instantiate<sensor_msgs::Image>());
    } else if (message.getTopic() == "/dvs/deblurred/camera_info") {
      infos.push_back(*message.instantiate<sensor_msgs::CameraInfo>());
    }
  }
  ASSERT_THAT(images, SizeIs(kFrames));
  ASSERT_THAT(infos, SizeIs(kFrames));
  for (std::size_t i = 0; i < kFrames; ++i) {
    EXPECT_EQ(images[i], *expected[i].image);
    EXPECT_EQ(infos[i], *expected[i].info);
  }
}

TEST_F(DeblurBagTool, GivesTheSameBytesEachTime) {
  ASSERT_EQ(run(paths() + kThresholds).exit_code, 0);
  const std::string first = contents(output_);
  ASSERT_EQ(run(paths() + " --force" + kThresholds).exit_code, 0);
  EXPECT_TRUE(contents(output_) == first);
}

TEST_F(DeblurBagTool, RecordsAnOutputBehindTheMessageThatCompletedIt) {
  ASSERT_EQ(run(paths() + kThresholds).exit_code, 0);
  ros::Time before = ros::TIME_MIN;
  std::size_t outputs = 0;
  for (const Raw& raw : readRaw(output_)) {
    EXPECT_GE(raw.time, before);
    if (raw.topic == "/dvs/deblurred/image_raw") {
      EXPECT_EQ(raw.time, before) << "not the time of the message before it";
      ++outputs;
    }
    before = raw.time;
  }
  EXPECT_EQ(outputs, static_cast<std::size_t>(kFrames));
}

TEST_F(DeblurBagTool, KeepsForeignTopicsLatchingAndCompression) {
  const std::string input = directory_.file("foreign.bag");
  {
    rosbag::Bag bag(input, rosbag::bagmode::Write);
    bag.setCompression(rosbag::compression::LZ4);
    const auto header = boost::make_shared<ros::M_string>();
    (*header)["type"] = "std_msgs/String";
    (*header)["md5sum"] = ros::message_traits::md5sum<std_msgs::String>();
    (*header)["message_definition"] = ros::message_traits::definition<std_msgs::String>();
    (*header)["latching"] = "1";
    (*header)["callerid"] = "/somebody";
    std_msgs::String text;
    text.data = "kept";
    bag.write("/note", ros::Time(900), text, header);
    for (const test::Arrival& arrival : recording_) {
      ros::Time time;
      time.fromNSec(static_cast<std::uint64_t>(arrival.time_ns));
      if (arrival.events) {
        bag.write("/cam/events", time, *arrival.events);
      } else if (arrival.image) {
        bag.write("/cam/image", time, *arrival.image);
      } else if (arrival.exposure) {
        bag.write("/cam/exposure", time, *arrival.exposure);
      }
    }
  }
  const auto result =
      run("--in '" + input + "' --out '" + output_ +
          "' --events /cam/events --image /cam/image --exposure /cam/exposure" + kThresholds);
  ASSERT_EQ(result.exit_code, 0) << result.output;
  const std::vector<Raw> all = readRaw(output_);
  EXPECT_EQ(without(all, "/cam/deblurred/"), readRaw(input));
  EXPECT_THAT(on(all, "/cam/deblurred/image_raw"), SizeIs(kFrames));
  EXPECT_EQ(BagReader(output_).compression(), "lz4");
  const std::vector<Raw> notes = on(all, "/note");
  ASSERT_THAT(notes, SizeIs(1));
  EXPECT_EQ(notes[0].header.at("latching"), "1");
  EXPECT_EQ(notes[0].header.at("callerid"), "/somebody");
}

TEST_F(DeblurBagTool, ProcessesWhatIsThereOfATruncatedBag) {
  const std::string whole = contents(input_);
  const std::string cut = directory_.file("cut.bag");
  const std::size_t size = whole.size() * 6 / 10;
  write(cut, whole.substr(0, size));
  const auto result = run("--in '" + cut + "' --out '" + output_ + "'" + kThresholds);
  EXPECT_EQ(result.exit_code, 2) << result.output;
  const std::vector<Raw> readable = readRaw(cut);
  ASSERT_FALSE(readable.empty());
  EXPECT_THAT(result.output,
              AllOf(HasSubstr("warning: " + cut + " (" + std::to_string(size) + " bytes)"),
                    HasSubstr("at byte " + std::to_string(size)),
                    HasSubstr("recorded at " + std::to_string(readable.back().time.sec) + ".")));
  EXPECT_EQ(contents(cut), whole.substr(0, size)) << "the input was touched";
  EXPECT_FALSE(fs::exists(output_ + ".active"));

  const std::vector<Raw> all = readRaw(output_);
  EXPECT_EQ(without(all, "/dvs/deblurred/"), readable);
  const std::size_t frames = on(readable, "/dvs/image_raw").size();
  EXPECT_GT(frames, 2u);
  EXPECT_THAT(on(all, "/dvs/deblurred/image_raw"), SizeIs(frames));
  const rosbag::Bag indexed(output_);
  EXPECT_EQ(rosbag::View(indexed).size(), all.size());
}

TEST_F(DeblurBagTool, ProcessesWhatIsThereOfADamagedBag) {
  std::string bytes = contents(input_);
  constexpr std::size_t kDamaged = 64;
  const std::size_t middle = bytes.size() / 2;
  for (std::size_t i = 0; i < kDamaged; ++i) {
    bytes[middle + i] = '\xa5';
  }
  // A message whose own lengths are wrong: the number of events of the first array, which lies
  // before the first event and behind the sensor's height and width (48 x 64).
  const std::string size("\x30\0\0\0\x40\0\0\0", 8);
  const std::size_t count = bytes.find(size) + size.size();
  ASSERT_LT(count, middle);
  bytes[count + 3] = '\x7f';
  const std::string damaged = directory_.file("damaged.bag");
  write(damaged, bytes);
  const auto result = run("--in '" + damaged + "' --out '" + output_ + "'" + kThresholds);
  EXPECT_EQ(result.exit_code, 2) << result.output;
  EXPECT_THAT(result.output, HasSubstr("malformed"));
  const std::vector<Raw> all = readRaw(output_);
  EXPECT_EQ(without(all, "/dvs/deblurred/"), readRaw(damaged));
  EXPECT_EQ(on(all, "/dvs/deblurred/image_raw").size(), on(all, "/dvs/image_raw").size());
}

TEST_F(DeblurBagTool, NamesAMissingTopicAndThoseThatAreThere) {
  const auto missing = run(paths() + " --image /camera/image_raw" + kThresholds);
  EXPECT_EQ(missing.exit_code, 1);
  EXPECT_THAT(
      missing.output,
      AllOf(HasSubstr("/camera/image_raw (--image, a sensor_msgs/Image) is not in the recording"),
            HasSubstr("/dvs/image_raw  sensor_msgs/Image  10 messages"),
            HasSubstr("/dvs/events  dvs_msgs/EventArray")));
  const auto wrong = run(paths() + " --events /dvs/image_raw" + kThresholds);
  EXPECT_EQ(wrong.exit_code, 1);
  EXPECT_THAT(wrong.output, HasSubstr("/dvs/image_raw (--events) is a sensor_msgs/Image, expected "
                                      "a dvs_msgs/EventArray"));
  EXPECT_FALSE(fs::exists(output_));
}

TEST_F(DeblurBagTool, RefusesTwoOutputsOfOneName) {
  const auto refused = run(paths() + " --force --save-learned '" + directory_.file("x/../out.bag") +
                           "'" + kThresholds);
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.output, HasSubstr("both --out and --save-learned name it"));
  EXPECT_FALSE(fs::exists(output_));
}

TEST_F(DeblurBagTool, FindsTopicsOfOtherNames) {
  const std::string other = directory_.file("other.bag");
  {
    const rosbag::Bag from(input_);
    rosbag::Bag to(other, rosbag::bagmode::Write);
    for (const rosbag::MessageInstance& message : rosbag::View(from)) {
      to.write("/camera" + message.getTopic().substr(std::string("/dvs").size()), message.getTime(),
               message);
    }
  }
  const auto result = run("--in '" + other + "' --out '" + output_ + "'" + kThresholds);
  EXPECT_EQ(result.exit_code, 0) << result.output;
  EXPECT_THAT(result.output,
              HasSubstr("no messages on /dvs/image_raw: /camera/image_raw is taken as the frames"));
  EXPECT_EQ(on(readRaw(output_), "/camera/deblurred/image_raw").size(), 10u);
}

TEST_F(DeblurBagTool, RefusesToDeblurTheSameRecordingTwice) {
  ASSERT_EQ(run(paths() + kThresholds).exit_code, 0);
  const std::string again = directory_.file("again.bag");
  const std::string arguments = "--in '" + output_ + "' --out '" + again + "'" + kThresholds;
  const auto refused = run(arguments);
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.output, HasSubstr("/dvs/deblurred/image_raw is in the recording already"));
  EXPECT_EQ(run(arguments + " --output /second").exit_code, 0);
  EXPECT_THAT(on(readRaw(again), "/second/image_raw"), SizeIs(kFrames));
}

TEST_F(DeblurBagTool, RefusesAWrongConfiguration) {
  const std::string config = directory_.file("wrong.yaml");
  write(config, "contrast_treshold_on: 0.3\ncontrast_threshold_off: 0.25\n");
  const auto misspelt = run(paths() + " --config '" + config + "'");
  EXPECT_EQ(misspelt.exit_code, 1);
  EXPECT_THAT(misspelt.output, HasSubstr("contrast_treshold_on"));
  const auto none = run(paths());
  EXPECT_EQ(none.exit_code, 1);
  EXPECT_THAT(none.output, HasSubstr("contrast_threshold_on"));
  EXPECT_EQ(run(paths() + " --config /nonexistent.yaml").exit_code, 1);
  EXPECT_FALSE(fs::exists(output_));
}

std::string lastLine(const std::string& output) {
  const std::size_t end = output.find_last_not_of('\n');
  return output.substr(output.rfind('\n', end) + 1);
}

TEST_F(DeblurBagTool, SaysWhenNoFrameWasDeblurred) {
  const std::string options = paths() + " --force" + kThresholds + " exposure_source:=parameter";
  const auto unknown = run(options);
  EXPECT_EQ(unknown.exit_code, 3) << unknown.output;
  EXPECT_THAT(
      lastLine(unknown.output),
      AllOf(HasSubstr("no frame was deblurred: 10 of 10 passed through unchanged, 10 for this "
                      "reason: exposure unknown"),
            HasSubstr("exposure_time_us:=")));
  EXPECT_THAT(on(readRaw(output_), "/dvs/deblurred/image_raw"), SizeIs(kFrames));
  const auto known = run(options + " exposure_time_us:=10000");
  EXPECT_EQ(known.exit_code, 0) << known.output;
  const auto asked_for = run(options + " passthrough:=true");
  EXPECT_EQ(asked_for.exit_code, 0) << asked_for.output;
  EXPECT_THAT(asked_for.output, Not(HasSubstr("no frame was deblurred")));
}

TEST_F(DeblurBagTool, SavesWhatItLearnedForTheNextRun) {
  const std::string learned = directory_.file("learned.yaml");
  const std::string save = " --save-learned '" + learned + "'";
  // In the input of the other tests, events and frames have nothing to do with each other.
  const std::string moving = directory_.file("moving.bag");
  ASSERT_EQ(testing::runCommand(FAST_EDI_TOOLS_DIR "/simulate_davis --no-ground-truth --frames 10 "
                                                   "--width 96 --height 72 --motion pan "
                                                   "--texture natural --out '" +
                                moving + "'")
                .exit_code,
            0);
  const auto first = run("--in '" + moving + "' --out '" + directory_.file("first.bag") + "'" +
                         save + kThresholds);
  ASSERT_EQ(first.exit_code, 0) << first.output;
  EXPECT_THAT(first.output, HasSubstr("written: " + learned));
  EXPECT_THAT(contents(learned),
              AllOf(HasSubstr("contrast_threshold_on: 0."), HasSubstr("event_delay_us: ")));
  // The next run starts there, and what the command line says comes before it.
  write(learned, "contrast_threshold_on: 0.4\ncontrast_threshold_off: 0.5\nevent_delay_us: 700\n");
  const std::string fixed = paths() +
                            " --force refine_contrast:=false refine_delay:=false"
                            " event_delay_us:=-50 ";
  ASSERT_EQ(run(fixed + "--learned '" + learned + "'").exit_code, 0);
  const std::string from_file = contents(output_);
  ASSERT_EQ(run(fixed + "contrast_threshold_on:=0.4 contrast_threshold_off:=0.5").exit_code, 0);
  EXPECT_TRUE(contents(output_) == from_file);
}

TEST_F(DeblurBagTool, SavesNothingWhereNothingWasLearned) {
  const std::string learned = directory_.file("learned.yaml");
  const std::string save = paths() + " --force --save-learned '" + learned + "'" + kThresholds;
  const auto still = run(save + " exposure_source:=parameter");
  EXPECT_EQ(still.exit_code, 3) << still.output;
  EXPECT_FALSE(fs::exists(learned));
  EXPECT_FALSE(fs::exists(learned + ".active"));
  write(learned, "# of an earlier recording\n");
  const auto off = run(save + " refine_contrast:=false refine_delay:=false");
  EXPECT_EQ(off.exit_code, 0) << off.output;
  EXPECT_THAT(
      off.output,
      AllOf(HasSubstr("warning: not written: " + learned + ": nothing was learned"),
            HasSubstr("refine_contrast or refine_delay"), Not(HasSubstr("\nwritten: " + learned))));
  EXPECT_EQ(contents(learned), "# of an earlier recording\n");
}

TEST_F(DeblurBagTool, RefusesToReplaceWhatWasLearned) {
  const std::string learned = directory_.file("learned.yaml");
  write(learned, "mine\n");
  const auto refused = run(paths() + " --save-learned '" + learned + "'" + kThresholds);
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.output, AllOf(HasSubstr(learned), HasSubstr("--force")));
  EXPECT_EQ(contents(learned), "mine\n");
  EXPECT_FALSE(fs::exists(output_));
  EXPECT_THAT(run(paths() + " --learned '" + learned + "'" + kThresholds).output,
              HasSubstr(learned));
}

TEST_F(DeblurBagTool, NeverWritesOverItsInputOrUnasked) {
  const std::string before = contents(input_);
  const auto onto_itself =
      run("--in '" + input_ + "' --out '" + input_ + "' --force" + kThresholds);
  EXPECT_EQ(onto_itself.exit_code, 1);
  EXPECT_THAT(onto_itself.output, HasSubstr("it is the input"));
  const std::string link = directory_.file("link.bag");
  fs::create_symlink(input_, link);
  EXPECT_EQ(run("--in '" + input_ + "' --out '" + link + "' --force" + kThresholds).exit_code, 1);
  // A recording that was killed: the name under which the output grows is taken by the input.
  const std::string killed = directory_.file("killed.bag");
  fs::copy(input_, killed + ".active");
  EXPECT_EQ(
      run("--in '" + killed + ".active' --out '" + killed + "' --force" + kThresholds).exit_code,
      1);
  const auto learned = run(paths() + " --force --save-learned '" + input_ + "'" + kThresholds);
  EXPECT_EQ(learned.exit_code, 1);
  EXPECT_THAT(learned.output, HasSubstr("it is the input"));
  EXPECT_EQ(contents(input_), before);
  EXPECT_EQ(contents(killed + ".active"), before);

  write(output_, "precious");
  const auto existing = run(paths() + kThresholds);
  EXPECT_EQ(existing.exit_code, 1);
  EXPECT_THAT(existing.output, HasSubstr("exists already"));
  EXPECT_EQ(contents(output_), "precious");
}

TEST_F(DeblurBagTool, SaysWhyItCannotWrite) {
  const auto nowhere = run("--in '" + input_ + "' --out /nonexistent/out.bag" + kThresholds);
  EXPECT_EQ(nowhere.exit_code, 1);
  EXPECT_THAT(nowhere.output, HasSubstr("No such file or directory"));
  // Every write to /dev/full fails as on a full disk.
  fs::create_symlink("/dev/full", output_ + ".active");
  const auto full = run(paths() + " --force" + kThresholds);
  EXPECT_EQ(full.exit_code, 1) << full.output;
  EXPECT_THAT(full.output, HasSubstr("No space left on device"));
  EXPECT_FALSE(fs::exists(output_));
}

TEST_F(DeblurBagTool, WritesTheSameOnAnyNumberOfThreads) {
  const std::string demo = std::string(FAST_EDI_SOURCE_DIR) + "/bags/demo.bag";
  const auto deblurred = [&](const std::string& threads) {
    const std::string out = directory_.file("out_" + threads);
    const auto result =
        run("--in '" + demo + "' --out " + out + ".bag --frames " + out + " --trust " + out +
            "_trust --compression lz4 --threads " + threads + kThresholds);
    EXPECT_EQ(result.exit_code, 0) << result.output;
    return out;
  };
  const std::string one = deblurred("1");
  for (const std::string threads : {"2", "4", "64"}) {
    const std::string more = deblurred(threads);
    EXPECT_TRUE(contents(more + ".bag") == contents(one + ".bag")) << threads << " threads";
    for (const std::string folder : {"", "_trust"}) {
      const auto same = testing::runCommand("diff -r " + one + folder + " " + more + folder);
      EXPECT_EQ(same.exit_code, 0) << same.output;
    }
  }
  for (const std::string threads : {"0", "65", "-1"}) {
    EXPECT_THAT(run(paths() + kThresholds + " --threads " + threads).output,
                HasSubstr("--threads " + threads + ": expected 1..64"));
  }
}

TEST_F(DeblurBagTool, ExplainsItself) {
  const auto help = run("--help");
  EXPECT_EQ(help.exit_code, 0);
  EXPECT_THAT(help.output, HasSubstr("Usage: deblur_bag --in IN.bag --out OUT.bag"));
  const auto incomplete = run("--in '" + input_ + "'");
  EXPECT_EQ(incomplete.exit_code, 1);
  EXPECT_THAT(incomplete.output, HasSubstr("--out"));
  EXPECT_EQ(run(paths() + " --nonsense").exit_code, 1);
  const auto no_bag =
      run("--in '" FAST_EDI_SOURCE_DIR "/package.xml' --out '" + output_ + "'" + kThresholds);
  EXPECT_EQ(no_bag.exit_code, 1);
  EXPECT_THAT(no_bag.output, HasSubstr("is no bag"));
}

}  // namespace
}  // namespace fast_edi
