#include "stream_node/camera_info_file.hpp"

#include <fstream>
#include <string>

#include <gmock/gmock.h>

#include "support/temporary_directory.hpp"

namespace fast_edi {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr char kCalibration[] =
    "image_width: 346\n"
    "image_height: 260\n"
    "camera_name: davis\n"
    "camera_matrix: {rows: 3, cols: 3, data: [250.5, 0, 170, 0, 251, 130, 0, 0, 1]}\n"
    "distortion_model: plumb_bob\n"
    "distortion_coefficients: {rows: 1, cols: 5, data: [-0.3, 0.1, 0, 0, 0]}\n"
    "rectification_matrix: {rows: 3, cols: 3, data: [1, 0, 0, 0, 1, 0, 0, 0, 1]}\n"
    "projection_matrix: {rows: 3, cols: 4, data: [240, 0, 170, 0, 0, 241, 130, 0, 0, 0, 1, 0]}\n";

std::string write(const TemporaryDirectory& directory, const std::string& text) {
  std::string path = directory.file("calibration.yaml");
  std::ofstream(path) << text;
  return path;
}

std::string refusal(const std::string& text) {
  const TemporaryDirectory directory;
  const std::string path = write(directory, text);
  try {
    readCameraInfoFile(path);
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr(path));
    return error.what();
  }
  return "accepted";
}

std::string changed(const std::string& from, const std::string& to) {
  std::string text = kCalibration;
  return text.replace(text.find(from), from.size(), to);
}

TEST(CameraInfoFile, IsRead) {
  const TemporaryDirectory directory;
  const sensor_msgs::CameraInfo info = readCameraInfoFile(write(directory, kCalibration));
  EXPECT_EQ(info.width, 346U);
  EXPECT_EQ(info.height, 260U);
  EXPECT_EQ(info.distortion_model, "plumb_bob");
  EXPECT_EQ(info.K[0], 250.5);
  EXPECT_EQ(info.K[5], 130.0);
  EXPECT_EQ(info.R[8], 1.0);
  EXPECT_EQ(info.P[5], 241.0);
  EXPECT_THAT(info.D, ElementsAre(-0.3, 0.1, 0.0, 0.0, 0.0));
}

TEST(CameraInfoFile, FaultsAreNamed) {
  EXPECT_THAT(refusal(changed("image_width", "width")), HasSubstr("has no image_width"));
  EXPECT_THAT(refusal(changed("250.5, ", "")),
              HasSubstr("camera_matrix has 8 numbers, expected 9"));
  EXPECT_THAT(refusal(changed("data: [240", "numbers: [240")),
              HasSubstr("projection_matrix has no list \"data\""));
  EXPECT_NE(refusal(changed("250.5", ".nan")), "accepted");
  EXPECT_NE(refusal(changed("346", "wide")), "accepted");
  EXPECT_NE(refusal("[1, 2"), "accepted");
  EXPECT_THAT(refusal("just text"), HasSubstr("has no image_width"));
  EXPECT_THROW(readCameraInfoFile("/no/such/file"), std::runtime_error);
}

}  // namespace
}  // namespace fast_edi
