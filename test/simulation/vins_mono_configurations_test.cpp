// The configurations of VINS-Mono are those of the simulated cameras.
#include <cmath>
#include <string>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "scenes/simulation_settings.hpp"

namespace fast_edi {
namespace {

struct Camera {
  const char* name;
  SensorSize size;
};

class VinsMonoConfigurationTest : public testing::TestWithParam<Camera> {
 protected:
  double number(const char* key) const { return file_[key]; }

  /// As VINS-Mono opens it.
  cv::FileStorage file_{
      std::string(FAST_EDI_SOURCE_DIR "/cfg/vins_mono/") + GetParam().name + ".yaml",
      cv::FileStorage::READ};
};

TEST_P(VinsMonoConfigurationTest, HasTheSimulatedCamera) {
  ASSERT_TRUE(file_.isOpened());
  SimulationSettings settings;
  settings.kind = SceneKind::kRoom;
  settings.sensor.size = GetParam().size;
  EXPECT_EQ(number("image_width"), GetParam().size.width);
  EXPECT_EQ(number("image_height"), GetParam().size.height);
  const cv::FileNode projection = file_["projection_parameters"];
  constexpr double kTolerance_px = 1e-6;
  EXPECT_NEAR(static_cast<double>(projection["fx"]), settings.focalLengthPx(), kTolerance_px);
  EXPECT_NEAR(static_cast<double>(projection["fy"]), settings.focalLengthPx(), kTolerance_px);
  EXPECT_EQ(static_cast<double>(projection["cx"]), (GetParam().size.width - 1) / 2.0);
  EXPECT_EQ(static_cast<double>(projection["cy"]), (GetParam().size.height - 1) / 2.0);
  cv::Mat rotation;
  cv::Mat translation;
  file_["extrinsicRotation"] >> rotation;
  file_["extrinsicTranslation"] >> translation;
  EXPECT_EQ(cv::norm(rotation, cv::Mat(cv::Mat::eye(3, 3, CV_64F))), 0.0);
  EXPECT_EQ(cv::norm(translation), 0.0);
}

TEST_P(VinsMonoConfigurationTest, HasTheSimulatedInertialSensor) {
  const ImuSettings imu;
  const double root_rate = std::sqrt(imu.rate_hz);  // VINS-Mono takes noise by sample
  EXPECT_DOUBLE_EQ(number("acc_n"), imu.accelerometer_noise * root_rate);
  EXPECT_DOUBLE_EQ(number("gyr_n"), imu.gyroscope_noise * root_rate);
  EXPECT_DOUBLE_EQ(number("acc_w"), imu.accelerometer_walk * root_rate);
  EXPECT_DOUBLE_EQ(number("gyr_w"), imu.gyroscope_walk * root_rate);
  EXPECT_EQ(number("g_norm"), 9.81);
}

TEST_P(VinsMonoConfigurationTest, TakesWhatTheNodeletGives) {
  // vins_mono.launch remaps these names.
  EXPECT_EQ(static_cast<std::string>(file_["image_topic"]), "/dvs/deblurred/image_raw");
  EXPECT_EQ(static_cast<std::string>(file_["imu_topic"]), "/dvs/imu");
  EXPECT_GE(number("freq"), 10.0);
  EXPECT_EQ(number("rolling_shutter"), 0.0);
  EXPECT_EQ(number("td"), 0.0);
  for (const char* key :
       {"model_type", "camera_name", "distortion_parameters", "max_cnt", "min_dist", "F_threshold",
        "show_track", "equalize", "fisheye", "max_solver_time", "max_num_iterations",
        "keyframe_parallax", "output_path", "estimate_extrinsic", "estimate_td"}) {
    EXPECT_FALSE(file_[key].empty()) << key;
  }
}

INSTANTIATE_TEST_SUITE_P(All, VinsMonoConfigurationTest,
                         testing::Values(Camera{"davis346", {346, 260}},
                                         Camera{"davis240c", {240, 180}}),
                         [](const testing::TestParamInfo<Camera>& camera) {
                           return std::string(camera.param.name);
                         });

}  // namespace
}  // namespace fast_edi
