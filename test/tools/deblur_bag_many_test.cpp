/// The program `deblur_bag` with many recordings (--out-dir).
#include <gmock/gmock.h>

#include <algorithm>
#include <csignal>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <system_error>
#include <vector>

#include <rosbag/bag.h>
#include <rosbag/view.h>

#include "fast_edi/bags/file_lock.hpp"
#include "rostest/child_process.hpp"
#include "rostest/node_client.hpp"
#include "rostest/recording.hpp"
#include "support/command.hpp"
#include "support/temporary_directory.hpp"

namespace fast_edi {
namespace {

namespace fs = std::filesystem;

using ::testing::AllOf;
using ::testing::ContainsRegex;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

const std::string kTool = std::string(FAST_EDI_TOOLS_DIR) + "/deblur_bag ";
const std::string kThresholds = " contrast_threshold_on:=0.3 contrast_threshold_off:=0.25";
/// Hundreds of images for each frame: there is time to interfere.
const std::string kSlow = kThresholds + " latent_images:=200";

class DeblurManyBags : public ::testing::Test {
 protected:
  DeblurManyBags() : folder_(path("out")) {}

  std::string path(const std::string& name) const { return directory_.file(name); }
  std::string inFolder(const std::string& name) const {
    return (fs::path(folder_) / name).string();
  }

  std::string makeBag(const std::string& name, std::uint32_t seed, int frames = 5) const {
    test::RecordingSettings settings;
    settings.frames = frames;
    settings.seed = seed;
    fs::create_directories(fs::path(path(name)).parent_path());
    test::writeBag(test::makeRecording(settings), "/dvs", path(name));
    return path(name);
  }
  /// As a single output.
  std::string deblurred(const std::string& input) const {
    const std::string output = path("single.bag");
    const auto result = testing::runCommand(kTool + "--force --in '" + input + "' --out '" +
                                            output + "'" + kThresholds);
    EXPECT_EQ(result.exit_code, 0) << result.output;
    return contents(output);
  }
  testing::CommandResult run(const std::vector<std::string>& inputs,
                             const std::string& more = "") const {
    std::string command = kTool + "--in";
    for (const std::string& input : inputs) {
      command += " '" + input + "'";
    }
    return testing::runCommand(command + " --out-dir '" + folder_ + "'" + kThresholds + more);
  }
  std::vector<std::string> written() const {
    std::vector<std::string> names;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder_)) {
      names.push_back(entry.path().filename().string());
    }
    std::sort(names.begin(), names.end());
    return names;
  }
  static std::string contents(const std::string& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  }

  const TemporaryDirectory directory_;
  const std::string folder_;
};

TEST_F(DeblurManyBags, EachBecomesWhatItBecomesAlone) {
  const std::string first = makeBag("first.bag", 1);
  const std::string second = makeBag("second.bag", 2);
  const auto result = run({first, second});
  EXPECT_EQ(result.exit_code, 0) << result.output;
  EXPECT_THAT(written(), ElementsAre("first.bag", "second.bag"));
  EXPECT_TRUE(contents(inFolder("first.bag")) == deblurred(first));
  EXPECT_TRUE(contents(inFolder("second.bag")) == deblurred(second));
  EXPECT_THAT(result.output,
              AllOf(HasSubstr(first + "\nframes\n"), HasSubstr("written: " + inFolder("first.bag")),
                    HasSubstr(second + "\nframes\n"), ContainsRegex("all recordings\n +2  done\n"),
                    ContainsRegex(" 0  failed\n"), ContainsRegex(" 10  frames in\n"),
                    ContainsRegex(" 10  frames deblurred\n")));
}

TEST_F(DeblurManyBags, OneThatFailsDoesNotEndTheRun) {
  const std::string good = makeBag("good.bag", 1);
  const std::string bad = path("bad.bag");
  std::ofstream(bad) << "no bag at all";
  const auto result = run({path("missing.bag"), bad, good});
  EXPECT_EQ(result.exit_code, 1) << result.output;
  EXPECT_THAT(written(), ElementsAre("good.bag"));
  EXPECT_THAT(result.output, AllOf(ContainsRegex(" 1  done\n"), ContainsRegex(" 2  failed\n"),
                                   HasSubstr("failed: " + bad + ": "),
                                   HasSubstr("failed: " + path("missing.bag") + ": ")));
}

TEST_F(DeblurManyBags, OneThatIsCutShortIsNamed) {
  const std::string cut = makeBag("cut.bag", 1, 40);
  fs::resize_file(cut, fs::file_size(cut) / 2);
  const auto result = run({cut, makeBag("whole.bag", 2)});
  EXPECT_EQ(result.exit_code, 2) << result.output;
  EXPECT_THAT(written(), ElementsAre("cut.bag", "whole.bag"));
  EXPECT_THAT(result.output, AllOf(ContainsRegex(" 2  done\n +1  of these cut short or damaged\n"),
                                   HasSubstr("warning: cut short or damaged: " + cut)));
}

TEST_F(DeblurManyBags, OneWithoutADeblurredFrameIsNamed) {
  const std::string good = makeBag("good.bag", 1);
  const std::string without = path("without.bag");
  {
    const rosbag::Bag from(good);
    rosbag::Bag to(without, rosbag::bagmode::Write);
    const std::vector<std::string> topics = {"/dvs/events", "/dvs/image_raw"};
    for (const rosbag::MessageInstance& message : rosbag::View(from, rosbag::TopicQuery(topics))) {
      to.write(message.getTopic(), message.getTime(), message);
    }
  }
  const auto result = run({without, good});
  EXPECT_EQ(result.exit_code, 3) << result.output;
  EXPECT_THAT(written(), ElementsAre("good.bag", "without.bag"));
  EXPECT_THAT(result.output, AllOf(ContainsRegex(" 1  of these without any deblurred frame\n"),
                                   HasSubstr("reason: exposure unknown"),
                                   HasSubstr("warning: no frame was deblurred: " + without)));
}

TEST_F(DeblurManyBags, AnOutputThatExistsIsReplacedByForceAlone) {
  const std::string input = makeBag("in.bag", 1);
  fs::create_directory(folder_);
  std::ofstream(inFolder("in.bag")) << "precious";
  const auto refused = run({input});
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.output, HasSubstr(inFolder("in.bag") + ": it exists already"));
  EXPECT_EQ(contents(inFolder("in.bag")), "precious");
  EXPECT_EQ(run({input}, " --force").exit_code, 0);
  EXPECT_TRUE(contents(inFolder("in.bag")) == deblurred(input));
}

TEST_F(DeblurManyBags, WhatDoesNotGoTogetherIsRefused) {
  const std::string a = makeBag("a/same.bag", 1);
  const std::string b = makeBag("b/same.bag", 2);
  const auto twice = run({a, b});
  EXPECT_EQ(twice.exit_code, 1);
  EXPECT_THAT(twice.output,
              HasSubstr(a + " and " + b + " would both become " + inFolder("same.bag")));
  for (const std::string option :
       {"--out x.bag", "--video x.avi", "--frames x", "--trust x", "--save-learned x.yaml"}) {
    const auto result = run({a}, " " + option);
    EXPECT_EQ(result.exit_code, 1) << option;
    EXPECT_THAT(result.output, HasSubstr("--out-dir writes a bag of each recording"));
  }
  EXPECT_FALSE(fs::exists(folder_));
  std::ofstream(folder_) << "a file";
  EXPECT_THAT(run({a}).output, HasSubstr("cannot make the folder " + folder_));
}

TEST_F(DeblurManyBags, TheInputIsNeverTheOutput) {
  fs::create_directory(folder_);
  const std::string input = makeBag("out/in.bag", 1);
  const std::string before = contents(input);
  const auto result = run({input}, " --force");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.output, HasSubstr("it is the input"));
  EXPECT_TRUE(contents(input) == before);
}

TEST_F(DeblurManyBags, NothingIsLeftWhereNothingCanBeWritten) {
  const std::string input = makeBag("in.bag", 1);
  const auto result = testing::runCommand("ulimit -f 0; " + kTool + "--in '" + input +
                                          "' --out-dir '" + folder_ + "'" + kThresholds);
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.output, HasSubstr("what was written so far is removed"));
  EXPECT_TRUE(fs::is_empty(folder_));
}

TEST_F(DeblurManyBags, WhatAKilledProcessLeftIsReplacedAndWhatOneWritesIsNot) {
  const std::string input = makeBag("in.bag", 1);
  fs::create_directory(folder_);
  const std::string active = inFolder("in.bag.active");
  std::ofstream(active) << "half a bag";
  FileLock writer;
  ASSERT_TRUE(writer.take(active));
  const auto refused = run({input});
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.output, HasSubstr("another process is writing " + active));
  EXPECT_EQ(contents(active), "half a bag");
  writer.release();
  const auto replaced = run({input});
  EXPECT_EQ(replaced.exit_code, 0) << replaced.output;
  EXPECT_THAT(written(), ElementsAre("in.bag"));
  EXPECT_TRUE(contents(inFolder("in.bag")) == deblurred(input));
}

TEST_F(DeblurManyBags, NothingIsLeftOfOneThatDoesNotFit) {
  const std::string large = makeBag("large.bag", 1, 100);
  const std::string small = makeBag("small.bag", 2, 1);
  const auto result =
      testing::runCommand("(ulimit -f 1000; " + kTool + "--in '" + large + "' '" + small +
                          "' --out-dir '" + folder_ + "'" + kThresholds + ")");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.output, AllOf(HasSubstr("File too large"), HasSubstr("is removed"),
                                   ContainsRegex(" 1  done\n")));
  EXPECT_THAT(written(), ElementsAre("small.bag"));
}

TEST_F(DeblurManyBags, AnInterruptionLeavesWhatIsComplete) {
  constexpr std::uintmax_t kSomeBytes = 1'000'000;
  const std::string first = makeBag("first.bag", 1);
  const std::string second = makeBag("second.bag", 2, 200);
  const std::string third = makeBag("third.bag", 3);
  test::ChildProcess child({"sh", "-c",
                            "exec " + kTool + "--in '" + first + "' '" + second + "' '" + third +
                                "' --out-dir '" + folder_ + "'" + kSlow + " > '" + path("log") +
                                "' 2>&1"});
  ASSERT_TRUE(test::waitUntil([this] {
    std::error_code not_yet;
    const std::uintmax_t size = fs::file_size(inFolder("second.bag.active"), not_yet);
    return !not_yet && size >= kSomeBytes;
  }));
  child.send(SIGINT);
  EXPECT_EQ(child.wait(), 128 + SIGINT);
  EXPECT_THAT(written(), ElementsAre("first.bag"));
  EXPECT_THAT(contents(path("log")),
              AllOf(HasSubstr("interrupted by SIGINT after"),
                    HasSubstr("there is no output of this recording"),
                    Not(HasSubstr("written: " + inFolder("second.bag"))),
                    ContainsRegex(" 1  done\n"), ContainsRegex(" 2  not done: interrupted\n")));
}

}  // namespace
}  // namespace fast_edi
