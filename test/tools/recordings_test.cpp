/// Whole recordings through the program `deblur_bag`.
#include <gmock/gmock.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>

#include <map>
#include <string>
#include <vector>

#include "support/command.hpp"
#include "support/recordings.hpp"
#include "support/temporary_directory.hpp"

namespace fast_edi {
namespace {

using ::testing::Le;
using ::testing::SizeIs;

struct BagContent {
  std::map<std::string, int> counts;
  std::vector<sensor_msgs::Image> inputs;
  std::vector<sensor_msgs::Image> outputs;
  std::vector<sensor_msgs::CameraInfo> output_infos;
};

BagContent read(const std::string& path) {
  BagContent content;
  const rosbag::Bag bag(path);
  for (const rosbag::MessageInstance& message : rosbag::View(bag)) {
    const std::string& topic = message.getTopic();
    ++content.counts[topic];
    if (topic == "/dvs/image_raw") {
      content.inputs.push_back(*message.instantiate<sensor_msgs::Image>());
    } else if (topic == "/dvs/deblurred/image_raw") {
      content.outputs.push_back(*message.instantiate<sensor_msgs::Image>());
    } else if (topic == "/dvs/deblurred/camera_info") {
      content.output_infos.push_back(*message.instantiate<sensor_msgs::CameraInfo>());
    }
  }
  return content;
}

/// The first recorded frame may lack the events of its exposure's beginning.
constexpr int kMaxUnchangedFrames = 1;

TEST(Recordings, EveryFrameIsDeblurredAndEveryMessageKept) {
  const TemporaryDirectory directory;
  for (const testing::NamedRecording& recording : testing::recordings()) {
    SCOPED_TRACE(recording.name);
    const std::string output = directory.file(recording.name + ".bag");
    const auto result =
        testing::runCommand(std::string(FAST_EDI_TOOLS_DIR) + "/deblur_bag --in '" +
                            recording.path + "' --out '" + output + "' --config '" +
                            FAST_EDI_SOURCE_DIR + "/cfg/davis346.yaml' " + recording.parameters);
    ASSERT_EQ(result.exit_code, 0) << result.output;

    const BagContent before = read(recording.path);
    const BagContent after = read(output);
    for (const std::string& topic : recording.topics) {
      EXPECT_GT(before.counts.at(topic), 0) << topic;
      EXPECT_EQ(after.counts.at(topic), before.counts.at(topic)) << topic;
    }
    ASSERT_THAT(after.inputs, SizeIs(recording.frames));
    ASSERT_THAT(after.outputs, SizeIs(recording.frames));
    ASSERT_THAT(after.output_infos, SizeIs(recording.frames));
    int unchanged = 0;
    for (std::size_t i = 0; i < after.outputs.size(); ++i) {
      const sensor_msgs::Image& image = after.outputs[i];
      EXPECT_EQ(image.header.stamp, after.output_infos[i].header.stamp);
      EXPECT_EQ(image.header.frame_id, after.output_infos[i].header.frame_id);
      EXPECT_EQ(image.encoding, before.inputs[i].encoding);
      ASSERT_EQ(image.data.size(), before.inputs[i].data.size());
      if (i > 0) {
        EXPECT_GT(image.header.stamp, after.outputs[i - 1].header.stamp);
      }
      unchanged += image.data == before.inputs[i].data ? 1 : 0;
    }
    EXPECT_THAT(unchanged, Le(kMaxUnchangedFrames)) << result.output;
  }
}

}  // namespace
}  // namespace fast_edi
