// The launch files for tags: the detector on both streams of a recording, and the way to
// apriltag_ros. Starts roslaunch itself, with a master of its own.

#include <map>
#include <set>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <visualization_msgs/MarkerArray.h>

#include "rostest/child_process.hpp"
#include "rostest/free_port.hpp"
#include "support/command.hpp"
#include "support/temporary_directory.hpp"

namespace fast_edi {
namespace test {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;
using visualization_msgs::Marker;

const std::string kLaunchFolder = FAST_EDI_SOURCE_DIR "/launch/";

/// Ids of the tags found, by the stamp of the image.
using TagsByStamp = std::map<ros::Time, std::multiset<int>>;

TagsByStamp readDetections(const std::string& path, const std::string& topic) {
  TagsByStamp tags;
  bool pose_known = false;
  rosbag::Bag bag(path);
  for (const rosbag::MessageInstance& message : rosbag::View(bag, rosbag::TopicQuery(topic))) {
    const auto array = message.instantiate<visualization_msgs::MarkerArray>();
    EXPECT_EQ(array->markers.at(0).action, Marker::DELETEALL);
    std::multiset<int>& here = tags[array->markers.at(0).header.stamp];
    for (const Marker& marker : array->markers) {
      EXPECT_EQ(marker.header.frame_id, "camera");
      if (marker.action == Marker::ADD) {
        EXPECT_EQ(marker.scale.x, 0.25);
        here.insert(marker.id);
        pose_known = marker.pose.position.z > 0.0;
      }
    }
  }
  EXPECT_TRUE(pose_known) << topic << ": the camera is calibrated, but the last tag has no pose";
  return tags;
}

std::size_t framesWithTag(const TagsByStamp& tags) {
  std::size_t frames = 0;
  for (const auto& [stamp, ids] : tags) {
    frames += ids == std::multiset<int>{0} ? 1 : 0;
  }
  return frames;
}

TEST(AprilTagLaunch, FindsTagsInBothStreamsOfARecording) {
  const TemporaryDirectory directory;
  const std::string in = directory.file("in.bag");
  const std::string out = directory.file("out.bag");
  const auto simulated = testing::runCommand(
      FAST_EDI_TOOLS_DIR "/simulate_davis --out " + in +
      " --frames 12 --motion shake --tags 1 --texture flat --noise none --seed 2");
  ASSERT_EQ(simulated.exit_code, 0) << simulated.output;
  ChildProcess launch({"roslaunch", "-p", freePort(), kLaunchFolder + "apriltag.launch",
                       "bag:=" + in, "record:=" + out, "tag_size_m:=0.25"});
  ASSERT_EQ(launch.wait(), 0);
  const TagsByStamp blurry = readDetections(out, "/dvs/tags_blurry/detections");
  const TagsByStamp deblurred = readDetections(out, "/dvs/tags_deblurred/detections");
  EXPECT_EQ(blurry.size(), 12U);
  EXPECT_EQ(deblurred.size(), 12U);
  EXPECT_EQ(framesWithTag(deblurred), 12U);
  EXPECT_LT(framesWithTag(blurry), 9U);
}

/// roslaunch's answer about apriltag_ros.launch, with stand-ins for packages that it names.
std::string ask(const std::string& question, const std::string& arguments = "") {
  const auto answer =
      testing::runCommand("ROS_PACKAGE_PATH='" FAST_EDI_SOURCE_DIR
                          "/test/rostest/stand_in':\"$ROS_PACKAGE_PATH\" roslaunch " +
                          question + " " + kLaunchFolder + "apriltag_ros.launch " + arguments);
  EXPECT_EQ(answer.exit_code, 0) << answer.output;
  return answer.output;
}

// apriltag_ros is not in Debian; what it would be started with is.
TEST(AprilTagRosLaunch, LeadsDeblurredFramesThroughImageProc) {
  const std::string nodes = ask("--nodes");
  EXPECT_THAT(nodes, HasSubstr("/dvs/deblurred/debayer"));
  EXPECT_THAT(nodes, HasSubstr("/dvs/deblurred/rectify"));
  EXPECT_THAT(nodes, HasSubstr("/dvs/deblurred/apriltag"));
  EXPECT_THAT(nodes, ::testing::Not(HasSubstr("/dvs/nodelet_manager"))) << "it runs already";
  // Names by which these nodelets find each other in their common namespace: image_raw, image_mono,
  // image_rect. None is remapped.
  const std::string detector = ask("--args /dvs/deblurred/apriltag");
  EXPECT_THAT(detector, HasSubstr("load apriltag_ros/ContinuousDetector /dvs/nodelet_manager"));
  EXPECT_THAT(detector, ::testing::Not(HasSubstr("image_rect:=")));
  EXPECT_THAT(ask("--args /dvs/deblurred/rectify"),
              HasSubstr("load image_proc/rectify /dvs/nodelet_manager"));
}

TEST(AprilTagRosLaunch, PassesItsArgumentsOn) {
  const std::string parameters =
      ask("--dump-params", "family:=25h9 standalone_tags:='[{id: 4, size: 0.3}]' decimate:=1.5");
  EXPECT_THAT(parameters, HasSubstr("/dvs/deblurred/apriltag/tag_family: tag25h9"));
  EXPECT_THAT(parameters, HasSubstr("/dvs/deblurred/apriltag/tag_decimate: 1.5"));
  EXPECT_THAT(parameters, HasSubstr("/dvs/deblurred/apriltag/standalone_tags:"));
  EXPECT_THAT(parameters, HasSubstr("size: 0.3"));
  EXPECT_THAT(ask("--args /cam/deblurred/apriltag", "namespace:=cam manager:=/other"),
              HasSubstr("load apriltag_ros/ContinuousDetector /other"));
  EXPECT_THAT(ask("--nodes", "start_manager:=true"), StartsWith("/dvs/nodelet_manager"));
}

}  // namespace
}  // namespace test
}  // namespace fast_edi
