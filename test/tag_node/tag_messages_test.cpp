#include "tag_node/tag_messages.hpp"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>

#include "tags/tag_pictures.hpp"

namespace fast_edi {
namespace {

using ::testing::HasSubstr;
using visualization_msgs::Marker;

const cv::Size kSize(346, 260);

sensor_msgs::CameraInfo calibration() {
  sensor_msgs::CameraInfo info;
  info.width = 346;
  info.height = 260;
  info.distortion_model = "plumb_bob";
  info.D = {-0.3, 0.1, 0.0, 0.0, 0.0};
  info.K = {330.0, 0.0, 172.0, 0.0, 331.0, 130.0, 0.0, 0.0, 1.0};
  info.P = {300.0, 0.0, 170.0, 0.0, 0.0, 301.0, 129.0, 0.0, 0.0, 0.0, 1.0, 0.0};
  return info;
}

std::string reasonFor(const sensor_msgs::CameraInfo& info, bool rectified = false) {
  const CameraReading reading = readCamera(&info, kSize, rectified);
  EXPECT_NE(reading.camera.has_value(), !reading.reason.empty());
  return reading.reason;
}

TEST(ReadCameraTest, TakesMatrixAndDistortion) {
  const sensor_msgs::CameraInfo info = calibration();
  const CameraReading reading = readCamera(&info, kSize, false);
  ASSERT_TRUE(reading.camera) << reading.reason;
  EXPECT_EQ(reading.camera->fx_px, 330.0);
  EXPECT_EQ(reading.camera->fy_px, 331.0);
  EXPECT_EQ(reading.camera->cx_px, 172.0);
  EXPECT_EQ(reading.camera->cy_px, 130.0);
  EXPECT_EQ(reading.camera->distortion.size(), 5U);
  EXPECT_FALSE(reading.camera->fisheye);
}

TEST(ReadCameraTest, ForRectifiedImagesTakesTheProjection) {
  const sensor_msgs::CameraInfo info = calibration();
  const CameraReading reading = readCamera(&info, kSize, true);
  ASSERT_TRUE(reading.camera) << reading.reason;
  EXPECT_EQ(reading.camera->fx_px, 300.0);
  EXPECT_EQ(reading.camera->cy_px, 129.0);
  EXPECT_TRUE(reading.camera->distortion.empty());
}

TEST(ReadCameraTest, KnowsDistortionModelsByName) {
  sensor_msgs::CameraInfo info = calibration();
  info.distortion_model = "equidistant";
  info.D = {0.1, 0.0, 0.0, 0.0};
  EXPECT_TRUE(readCamera(&info, kSize, false).camera->fisheye);
  info.distortion_model = "rational_polynomial";
  info.D.assign(8, 0.0);
  EXPECT_EQ(reasonFor(info), "");
  info.distortion_model = "";
  info.D.clear();
  EXPECT_EQ(reasonFor(info), "");
}

TEST(ReadCameraTest, SaysWhyThereIsNoCamera) {
  EXPECT_EQ(readCamera(nullptr, kSize, false).reason, "no camera_info was received");
  sensor_msgs::CameraInfo info = calibration();
  info.K.fill(0.0);
  EXPECT_THAT(reasonFor(info), HasSubstr("K of camera_info is zero"));
  EXPECT_EQ(reasonFor(info, true), "") << "P is not";
  info = calibration();
  info.K[0] = -1.0;
  EXPECT_THAT(reasonFor(info), HasSubstr("focal lengths above 0"));
  info = calibration();
  info.K[5] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(reasonFor(info), HasSubstr("finite"));
  info = calibration();
  info.width = 240;
  info.height = 180;
  EXPECT_THAT(reasonFor(info), HasSubstr("for 240x180 pixels, the image has 346x260"));
  info = calibration();
  info.distortion_model = "wavy";
  EXPECT_THAT(reasonFor(info), HasSubstr("\"wavy\", expected plumb_bob"));
  info = calibration();
  info.D.pop_back();
  EXPECT_THAT(reasonFor(info), HasSubstr("4 coefficients in D, expected 5"));
  info = calibration();
  info.D[0] = std::numeric_limits<double>::infinity();
  EXPECT_THAT(reasonFor(info), HasSubstr("D is not finite"));
}

TagDetection tagAt(int id, cv::Point2d centre) {
  TagDetection tag;
  tag.id = id;
  tag.centre = centre;
  tag.corners = test::squareAt(centre, 40.0);
  return tag;
}

std_msgs::Header header() {
  std_msgs::Header header;
  header.stamp = ros::Time(12, 345);
  header.frame_id = "camera";
  return header;
}

CameraModel camera() {
  CameraModel model;
  model.fx_px = model.fy_px = 330.0;
  model.cx_px = 172.5;
  model.cy_px = 129.5;
  return model;
}

TEST(TagMarkersTest, OneForEachTagBehindOneThatClears) {
  const auto array =
      makeTagMarkers(header(), {tagAt(3, {60, 70}), tagAt(8, {200, 90})}, camera(), {"36h11", 0.2});
  ASSERT_EQ(array->markers.size(), 3U);
  EXPECT_EQ(array->markers[0].action, Marker::DELETEALL);
  for (const Marker& marker : array->markers) {
    EXPECT_EQ(marker.header.stamp, ros::Time(12, 345));
    EXPECT_EQ(marker.header.frame_id, "camera");
    EXPECT_EQ(marker.ns, "36h11");
  }
  const Marker& marker = array->markers[2];
  EXPECT_EQ(marker.action, Marker::ADD);
  EXPECT_EQ(marker.id, 8);
  ASSERT_EQ(marker.points.size(), 4U);
  EXPECT_EQ(marker.points[0].x, 180.0);
  EXPECT_EQ(marker.points[0].y, 110.0);
  EXPECT_EQ(marker.points[2].x, 220.0);
  EXPECT_EQ(marker.points[2].y, 70.0);
  EXPECT_EQ(marker.points[2].z, 0.0);
}

TEST(TagMarkersTest, WithACameraThePoseIsTheTags) {
  const auto array = makeTagMarkers(header(), {tagAt(1, {205.5, 129.5})}, camera(), {"36h11", 0.2});
  const Marker& marker = array->markers.at(1);
  // 40 px of 330 px focal length show 0.2 m: 1.65 m away, and 33 px beside the centre 0.165 m.
  EXPECT_NEAR(marker.pose.position.x, 0.165, 1e-3);
  EXPECT_NEAR(marker.pose.position.y, 0.0, 1e-3);
  EXPECT_NEAR(marker.pose.position.z, 1.65, 1e-3);
  EXPECT_NEAR(std::abs(marker.pose.orientation.x), 1.0, 1e-3) << "faces the camera, upright";
  EXPECT_EQ(marker.type, Marker::CUBE);
  EXPECT_EQ(marker.scale.x, 0.2);
  EXPECT_GT(marker.scale.z, 0.0);
  EXPECT_GT(marker.color.a, 0.5);
}

TEST(TagMarkersTest, WithoutACameraTheMarkerCannotBeSeen) {
  const auto array = makeTagMarkers(header(), {tagAt(1, {60, 70})}, std::nullopt, {"36h11", 0.2});
  const Marker& marker = array->markers.at(1);
  EXPECT_EQ(marker.color.a, 0.0F);
  EXPECT_EQ(marker.pose.position.z, 0.0);
  EXPECT_EQ(marker.pose.orientation.w, 1.0);
  EXPECT_EQ(marker.points.size(), 4U);
}

TEST(TagMarkersTest, WithoutTagsOnlyClears) {
  EXPECT_EQ(makeTagMarkers(header(), {}, camera(), {"36h11", 0.2})->markers.size(), 1U);
}

}  // namespace
}  // namespace fast_edi
