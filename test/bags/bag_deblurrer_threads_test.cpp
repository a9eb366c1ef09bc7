/// BagDeblurrer on several threads.
#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

#include "fast_edi/bags/bag_deblurrer.hpp"
#include "fast_edi/bags/open_messages.hpp"
#include "rostest/recording.hpp"
#include "support/temporary_directory.hpp"

namespace fast_edi {
namespace {

/// As many as eight threads are at work on.
constexpr std::uint32_t kFrames = 8;

struct Result {
  std::string bag;
  std::vector<std::vector<std::uint8_t>> trust;
  BagDeblurReport report;
};

class BagDeblurrerThreads : public ::testing::Test {
 protected:
  BagDeblurrerThreads() {
    test::RecordingSettings settings;
    settings.frames = kFrames;
    settings.event_period_ns = 500;  // several chunks of the log in each exposure
    settings.exposure_ns = 35 * kNanosecondsPerMillisecond;
    settings.array_period_ns = 7 * kNanosecondsPerMillisecond;
    test::writeBag(test::makeRecording(settings), "/dvs", input_);
    parameters_.deblur = test::testParameters();
    parameters_.deblur.filter = {};
  }

  Result deblur(std::size_t threads) {
    Result result;
    const std::string output = directory_.file("out.bag");
    const auto reader = openMessages(input_);
    BagWriter writer(output, {input_}, reader->compression(), true);
    if (reader->compression() != "none") {
      writer.copyChunksOf(*reader->chunks());
    }
    BagDeblurrer deblurrer(*reader, &writer, TopicNames(), parameters_,
                           [](std::uint64_t, std::uint64_t) {});
    deblurrer.setThreads(threads);
    deblurrer.showTrust();
    deblurrer.setOutputHandler(
        [&](const BagPipeline::Output& out) { result.trust.push_back(out.trust->data); });
    result.report = deblurrer.run();
    writer.close();
    std::ifstream file(output, std::ios::binary);
    result.bag = {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    return result;
  }

  void expectTheSame() {
    const Result one = deblur(1);
    EXPECT_EQ(one.report.counters.frames_deblurred, kFrames);
    for (const std::size_t threads : {3, 8}) {
      const Result more = deblur(threads);
      EXPECT_TRUE(more.bag == one.bag) << threads << " threads";
      EXPECT_TRUE(more.trust == one.trust) << threads << " threads";
      EXPECT_EQ(more.report.messages, one.report.messages);
      EXPECT_EQ(more.report.outputs, one.report.outputs);
      EXPECT_EQ(more.report.counters.events_in, one.report.counters.events_in);
      EXPECT_EQ(more.report.last_record_time, one.report.last_record_time);
      EXPECT_EQ(more.report.thresholds.on, one.report.thresholds.on);
    }
  }

  const TemporaryDirectory directory_;
  const std::string input_ = directory_.file("in.bag");
  LoadedParameters parameters_;
};

TEST_F(BagDeblurrerThreads, GiveTheBitsOfOneWhereChunksAreCopied) {
  const std::string plain = directory_.file("plain.bag");
  std::filesystem::rename(input_, plain);
  {
    rosbag::Bag bag(input_, rosbag::bagmode::Write);
    bag.setCompression(rosbag::compression::LZ4);
    const rosbag::Bag source(plain);
    for (const rosbag::MessageInstance& message : rosbag::View(source)) {
      bag.write(message.getTopic(), message.getTime(), message, message.getConnectionHeader());
    }
  }
  expectTheSame();
}

TEST_F(BagDeblurrerThreads, GiveTheBitsOfOne) {
  expectTheSame();
}

TEST_F(BagDeblurrerThreads, GiveTheBitsOfOneWhereFramesDependOnEachOther) {
  parameters_.deblur.filter.temporal = 0.5;
  expectTheSame();
  parameters_.deblur.filter.temporal = 0.0;
  parameters_.deblur.reference = ExposureInstant::kStart;
  expectTheSame();
  parameters_.deblur.latent.per_exposure = 3;
  expectTheSame();
}

TEST_F(BagDeblurrerThreads, EndWhereTheyAreAskedTo) {
  const auto reader = openMessages(input_);
  BagDeblurrer deblurrer(*reader, nullptr, TopicNames(), parameters_,
                         [](std::uint64_t, std::uint64_t) {});
  int asked = 0;
  deblurrer.setStopRequest([&asked] { return ++asked > 20; });
  deblurrer.setThreads(4);
  const BagDeblurReport report = deblurrer.run();
  EXPECT_TRUE(report.interrupted);
  EXPECT_EQ(report.messages, 20u);
}

TEST_F(BagDeblurrerThreads, ThrowWhatAnOutputThrows) {
  const auto reader = openMessages(input_);
  BagDeblurrer deblurrer(*reader, nullptr, TopicNames(), parameters_,
                         [](std::uint64_t, std::uint64_t) {});
  deblurrer.setOutputHandler(
      [](const BagPipeline::Output&) { throw std::runtime_error("the film is full"); });
  deblurrer.setThreads(3);
  try {
    deblurrer.run();
    FAIL() << "nothing was thrown";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "the film is full");
  }
}

}  // namespace
}  // namespace fast_edi
