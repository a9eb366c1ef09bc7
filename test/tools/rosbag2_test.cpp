/// The deblurred frames of a rosbag2 are those of the same recording as a bag.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "fast_edi/bags/bag_reader.hpp"
#include "support/command.hpp"
#include "support/temporary_directory.hpp"

namespace fast_edi {
namespace {

const std::string kTools = std::string(FAST_EDI_TOOLS_DIR) + "/";
const std::string kData = std::string(FAST_EDI_SOURCE_DIR) + "/test/data/recordings/";

/// Serialised, without the number of each in front.
std::vector<std::string> deblurredFrames(const std::string& recording, const std::string& output) {
  const testing::CommandResult result =
      testing::runCommand(kTools + "deblur_bag --in '" + recording + "' --out '" + output +
                          "' --config '" + FAST_EDI_SOURCE_DIR + "/cfg/davis346.yaml'");
  EXPECT_EQ(result.exit_code, 0) << result.output;
  std::vector<std::string> frames;
  BagReader reader(output);
  BagMessage message;
  while (reader.next(message)) {
    if (message.connection->topic == "/dvs/deblurred/image_raw") {
      frames.emplace_back(reinterpret_cast<const char*>(message.data) + sizeof(std::uint32_t),
                          message.size - sizeof(std::uint32_t));
    }
  }
  return frames;
}

class Rosbag2Tools : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Kinds, Rosbag2Tools,
                         ::testing::Values("sqlite", "mcap_chunk", "sqlite_file", "mcap_message",
                                           "libcaer"),
                         [](const auto& kind) { return std::string(kind.param); });

TEST_P(Rosbag2Tools, DeblurTheFramesOfTheBag) {
  const TemporaryDirectory directory;
  const std::string bag = directory.file("in.bag");
  // The vendor's file of the same recording, as a bag.
  const testing::CommandResult converted = testing::runCommand(
      kTools + "convert_recording '" + kData + "vendor_none.aedat4' '" + bag + "'");
  ASSERT_EQ(converted.exit_code, 0) << converted.output;
  const std::vector<std::string> expected = deblurredFrames(bag, directory.file("bag.bag"));
  EXPECT_EQ(expected.size(), 3U);
  EXPECT_EQ(deblurredFrames(kData + "rosbag2/" + GetParam(), directory.file("rosbag2.bag")),
            expected);
}

}  // namespace
}  // namespace fast_edi
