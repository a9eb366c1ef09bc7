/// `deblur_bag` copies chunks as they are, and others' tools do not notice.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include "fast_edi/bags/bag_index.hpp"
#include "rostest/recording.hpp"
#include "support/command.hpp"
#include "support/temporary_directory.hpp"

namespace fast_edi {
namespace {

using testing::CommandResult;
using ::testing::HasSubstr;
using ::testing::IsSupersetOf;
using ::testing::Not;
using testing::runCommand;

const std::string kTool = std::string(FAST_EDI_TOOLS_DIR) + "/deblur_bag";
const std::string kThresholds = " contrast_threshold_on:=0.3 contrast_threshold_off:=0.25";
const std::string kMessages = std::string(FAST_EDI_SOURCE_DIR) + "/test/tools/bag_messages ";

std::string run(const std::string& command) {
  const CommandResult result = runCommand(command);
  EXPECT_EQ(result.exit_code, 0) << command << "\n" << result.output;
  return result.output;
}

std::vector<std::string> sortedLines(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) {
    lines.push_back(line);
  }
  std::sort(lines.begin(), lines.end());
  return lines;
}

std::vector<std::string> chunksOf(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  const FileSource file(path);
  std::vector<std::string> chunks;
  for (const BagChunk& chunk : buildBagIndex(file, path).chunks) {
    chunks.push_back(bytes.substr(chunk.offset, chunk.size));
  }
  return chunks;
}

class DeblurBagChunks : public ::testing::TestWithParam<const char*> {
 protected:
  DeblurBagChunks() {
    test::RecordingSettings settings;
    settings.frames = 10;
    const std::string plain = file("plain.bag");
    test::writeBag(test::makeRecording(settings), "/dvs", plain);
    const std::string compression = GetParam();
    rosbag::Bag bag(input_, rosbag::bagmode::Write);
    bag.setCompression(compression == "lz4" ? rosbag::compression::LZ4 : rosbag::compression::BZ2);
    bag.setChunkThreshold(30'000);
    const rosbag::Bag source(plain);
    for (const rosbag::MessageInstance& message : rosbag::View(source)) {
      bag.write(message.getTopic(), message.getTime(), message, message.getConnectionHeader());
    }
  }

  std::string file(const std::string& name) const { return directory_.file(name); }
  std::string deblur(const std::string& output, const std::string& options = "") const {
    run(kTool + " --in " + input_ + " --out " + file(output) + kThresholds + options);
    return file(output);
  }

  const TemporaryDirectory directory_;
  const std::string input_ = file("in.bag");
};

INSTANTIATE_TEST_SUITE_P(Both, DeblurBagChunks, ::testing::Values("bz2", "lz4"));

TEST_P(DeblurBagChunks, AreThoseOfTheInput) {
  const std::vector<std::string> chunks = chunksOf(input_);
  ASSERT_GT(chunks.size(), 3u);
  EXPECT_THAT(chunksOf(deblur("copied.bag")), IsSupersetOf(chunks));
  EXPECT_THAT(chunksOf(deblur("written.bag", " --rewrite")), Not(IsSupersetOf(chunks)));
}

TEST_P(DeblurBagChunks, HaveTheMessagesOfThoseThatAreWrittenAnew) {
  const std::string copied = run(kMessages + deblur("copied.bag"));
  const std::string written = run(kMessages + deblur("written.bag", " --rewrite"));
  EXPECT_THAT(copied, HasSubstr("/dvs/deblurred/image_raw"));
  EXPECT_TRUE(sortedLines(copied) == sortedLines(written));
  EXPECT_THAT(sortedLines(copied), IsSupersetOf(sortedLines(run(kMessages + input_))));
}

TEST_P(DeblurBagChunks, AreWhatTheToolsOfRosbagExpect) {
  const std::string output = deblur("out.bag");
  const std::string info = run("rosbag info --yaml " + output);
  EXPECT_THAT(info, HasSubstr("indexed: True"));
  EXPECT_THAT(info, HasSubstr("topic: /dvs/deblurred/image_raw"));
  const std::string compression = GetParam();
  EXPECT_THAT(info, HasSubstr("compression: " + compression));
  // Not `rosbag check`: Python 3.13 breaks it for each type that is not installed.
  run("mkdir " + file("plain") + " && rosbag decompress --quiet --output-dir " + file("plain") +
      " " + output);
  EXPECT_EQ(run(kMessages + file("plain/out.bag")), run(kMessages + output));
}

TEST_P(DeblurBagChunks, AreWrittenAnewInAnotherCompression) {
  const std::string other = GetParam() == std::string("lz4") ? "none" : "lz4";
  const std::string output = deblur("out.bag", " --compression " + other);
  const FileSource source(output);
  for (const BagChunk& chunk : buildBagIndex(source, output).chunks) {
    EXPECT_EQ(chunk.compression, other);
  }
  EXPECT_TRUE(sortedLines(run(kMessages + output)) ==
              sortedLines(run(kMessages + deblur("same.bag"))));
}

TEST_P(DeblurBagChunks, OfSeveralBagsAreWrittenAnew) {
  {
    const rosbag::Bag source(input_);
    rosbag::Bag first(file("a.bag"), rosbag::bagmode::Write);
    rosbag::Bag second(file("b.bag"), rosbag::bagmode::Write);
    int number = 0;
    const auto half = rosbag::View(source).size() / 2;
    for (const rosbag::MessageInstance& message : rosbag::View(source)) {
      rosbag::Bag& bag = static_cast<std::uint32_t>(number++) < half ? first : second;
      bag.write(message.getTopic(), message.getTime(), message, message.getConnectionHeader());
    }
  }
  run(kTool + " --in " + file("a.bag") + " " + file("b.bag") + " --out " + file("out.bag") +
      kThresholds);
  EXPECT_TRUE(sortedLines(run(kMessages + file("out.bag"))) ==
              sortedLines(run(kMessages + deblur("one.bag"))));
}

}  // namespace
}  // namespace fast_edi
