/// The program `deblur_bag` when it is killed, interrupted, or runs out of space.
#include <gmock/gmock.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <csignal>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <system_error>
#include <vector>

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
using ::testing::HasSubstr;

const std::string kTool = std::string(FAST_EDI_TOOLS_DIR) + "/deblur_bag ";
/// Hundreds of images for each frame: there is time to interfere.
const std::string kSlow =
    " contrast_threshold_on:=0.3 contrast_threshold_off:=0.25 latent_images:=200";
/// Some of rosbag's chunks.
constexpr std::uintmax_t kSomeBytes = 3'000'000;
constexpr std::uint32_t kChunkBytes = 10'000;
/// The same as a limit of the shell's, in its units of 512 bytes.
const std::string kLimited = "ulimit -f 6000; ";

class DeblurBagFaults : public ::testing::Test {
 protected:
  DeblurBagFaults()
      : input_(path("in.bag")), output_(path("out.bag")), active_(output_ + ".active") {
    test::RecordingSettings settings;
    settings.frames = 100;
    const std::string recorded = path("recorded.bag");
    test::writeBag(test::makeRecording(settings), "/dvs", recorded);
    cut(recorded);
    before_ = contents(input_);
  }
  void TearDown() override { EXPECT_TRUE(contents(input_) == before_) << "the input was touched"; }

  /// Into compressed chunks so small that many are copied before the output is disturbed.
  void cut(const std::string& recorded) const {
    rosbag::Bag bag(input_, rosbag::bagmode::Write);
    bag.setCompression(rosbag::compression::LZ4);
    bag.setChunkThreshold(kChunkBytes);
    const rosbag::Bag source(recorded);
    for (const rosbag::MessageInstance& message : rosbag::View(source)) {
      bag.write(message.getTopic(), message.getTime(), message, message.getConnectionHeader());
    }
  }

  std::string path(const std::string& name) const { return directory_.file(name); }
  std::string toBag() const {
    return kTool + "--in '" + input_ + "' --out '" + output_ + "'" + kSlow;
  }
  std::string toFilm(const std::string& film, const std::string& rate = "10000") const {
    return kTool + "--in '" + input_ + "' --video '" + film + "' --fps " + rate + kSlow;
  }

  static std::string contents(const std::string& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  }

  /// Sends \p signal in the midst of writing to \p growing.
  /// \return the exit code, -1 if the signal ended the program
  int disturb(const std::string& command, const std::string& growing, int signal) const {
    test::ChildProcess child({"sh", "-c", "exec " + command + " > '" + path("log") + "' 2>&1"});
    EXPECT_TRUE(test::waitUntil([&growing] {
      std::error_code not_yet;
      const std::uintmax_t size = fs::file_size(growing, not_yet);
      return !not_yet && size >= kSomeBytes;
    }));
    child.send(signal);
    return child.wait();
  }

  /// Makes an index for what is left, and looks into it: it begins as the whole output does.
  void expectThatReindexOpensTheRest() const {
    EXPECT_FALSE(fs::exists(output_)) << "an incomplete bag under the name of a complete one";
    const auto reindexed = testing::runCommand("rosbag reindex --quiet '" + active_ + "'");
    ASSERT_EQ(reindexed.exit_code, 0) << reindexed.output;
    rosbag::Bag bag(active_);
    rosbag::Bag input(input_);
    rosbag::View whole(input);
    rosbag::View rest(bag, [](const rosbag::ConnectionInfo* connection) {
      return connection->topic.find("/dvs/deblurred") != 0 &&
             connection->topic.find("/dvs/latent") != 0;
    });
    ASSERT_GT(rest.size(), 0u);
    EXPECT_LT(rest.size(), whole.size());
    auto expected = whole.begin();
    for (const rosbag::MessageInstance& message : rest) {
      EXPECT_EQ(message.getTime(), expected->getTime());
      EXPECT_EQ(message.getTopic(), expected->getTopic());
      EXPECT_EQ(message.size(), expected->size());
      ++expected;
    }
    EXPECT_GT(rosbag::View(bag, rosbag::TopicQuery("/dvs/deblurred/image_raw")).size(), 0u);
  }

  const TemporaryDirectory directory_;
  const std::string input_;
  const std::string output_;
  const std::string active_;

 private:
  std::string before_;
};

TEST_F(DeblurBagFaults, WhatKillLeavesCanBeReindexed) {
  EXPECT_EQ(disturb(toBag(), active_, SIGKILL), -1);
  expectThatReindexOpensTheRest();
}

TEST_F(DeblurBagFaults, WhatKillLeavesCanBeReindexedWhenNotCompressed) {
  EXPECT_EQ(disturb(toBag() + " --compression none", active_, SIGKILL), -1);
  expectThatReindexOpensTheRest();
}

TEST_F(DeblurBagFaults, AFullDiskIsNamedAndWhatItHoldsCanBeReindexed) {
  const auto result = testing::runCommand("(" + kLimited + toBag() + ")");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.output, AllOf(HasSubstr("cannot write " + active_),
                                   HasSubstr("File too large"), HasSubstr("without an index")));
  expectThatReindexOpensTheRest();
}

TEST_F(DeblurBagFaults, AnInterruptionClosesTheOutput) {
  EXPECT_EQ(disturb(toBag(), active_, SIGINT), 128 + SIGINT);
  EXPECT_THAT(contents(path("log")),
              AllOf(ContainsRegex("interrupted by SIGINT after [0-9]+ of [0-9]+ messages"),
                    HasSubstr("written: " + output_)));
  EXPECT_FALSE(fs::exists(active_));
  const rosbag::Bag bag(output_);
  EXPECT_GT(rosbag::View(bag, rosbag::TopicQuery("/dvs/deblurred/image_raw")).size(), 0u);
  const std::size_t frames = rosbag::View(bag, rosbag::TopicQuery("/dvs/image_raw")).size();
  EXPECT_LT(frames, 100u);
  EXPECT_EQ(rosbag::View(bag, rosbag::TopicQuery("/dvs/deblurred/image_raw")).size(), frames);
}

TEST_F(DeblurBagFaults, AnInterruptionClosesTheFilm) {
  const std::string film = path("film.avi");
  EXPECT_EQ(disturb(toFilm(film), path("film.active.avi"), SIGTERM), 128 + SIGTERM);
  EXPECT_THAT(contents(path("log")),
              AllOf(HasSubstr("interrupted by SIGTERM"), HasSubstr("written: " + film)));
  EXPECT_TRUE(fs::exists(film));
  EXPECT_FALSE(fs::exists(path("film.active.avi")));
}

TEST_F(DeblurBagFaults, AKilledFilmDoesNotHaveItsName) {
  const std::string film = path("film.avi");
  EXPECT_EQ(disturb(toFilm(film), path("film.active.avi"), SIGKILL), -1);
  EXPECT_FALSE(fs::exists(film));
}

TEST_F(DeblurBagFaults, AFilmThatDoesNotFitIsNamedAndRemoved) {
  for (const std::string name : {"film.avi", "film.mp4"}) {
    SCOPED_TRACE(name);
    const auto limited = testing::runCommand("(ulimit -f 200; " + toFilm(path(name), "200") + ")");
    EXPECT_EQ(limited.exit_code, 1);
    EXPECT_THAT(limited.output,
                AllOf(HasSubstr("cannot write " + path(name)), HasSubstr("File too large")));
    EXPECT_FALSE(fs::exists(path(name)));
    EXPECT_FALSE(fs::exists(path("film.active" + fs::path(name).extension().string())));
  }
}

TEST_F(DeblurBagFaults, AFilmOnAFullDiskIsNamed) {
  fs::create_symlink("/dev/full", path("film.active.mp4"));
  const auto full = testing::runCommand(toFilm(path("film.mp4")) + " --force");
  EXPECT_EQ(full.exit_code, 1);
  EXPECT_THAT(full.output, AllOf(HasSubstr("cannot write " + path("film.mp4")),
                                 HasSubstr("No space left on device")));
  EXPECT_FALSE(fs::exists(path("film.mp4")));
}

}  // namespace
}  // namespace fast_edi
