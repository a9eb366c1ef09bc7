// The launch file of each driver, with this test in the driver's place: see davis_ros_driver.test
// and dv_ros.test, which name the driver as the argument.

#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <ros/init.h>

#include "rostest/child_process.hpp"
#include "rostest/driver_shape.hpp"
#include "rostest/expectations.hpp"
#include "rostest/fake_driver.hpp"
#include "rostest/node_client.hpp"
#include "support/command.hpp"
#include "support/temporary_directory.hpp"

namespace fast_edi {
namespace test {
namespace {

using Settings = std::map<std::string, int>;

constexpr int kExposure_us = 25'000;

struct DriverCase {
  DriverShape shape;
  Settings expected_settings;
  std::vector<std::string> encodings;  ///< that the driver publishes
  std::string camera;                  ///< options of simulate_davis for the biases in force
  std::string deblur_bag;              ///< parameters of the launch file
  std::string offline_namespace;       ///< where deblur_bag puts its output
};

DriverCase davisRosDriverCase() {
  return {davisRosDriver(),
          {{"streaming_rate", 100},
           {"background_activity_filter_enabled", 0},
           {"refractory_period_enabled", 0},
           {"skip_enabled", 0},
           {"polarity_suppress", 0},
           {"polarity_flatten", 0}},
          {"mono8", "rgb8"},
          "--threshold-on 0.2003 --threshold-off 0.2421",
          "--config " FAST_EDI_SOURCE_DIR
          "/cfg/davis346.yaml "
          "biases:=" FAST_EDI_SOURCE_DIR "/test/rostest/driver_biases.yaml",
          "/dvs/deblurred"};
}

DriverCase dvRosCase() {
  return {dvRos(),
          {{"auto_exposure", 0}, {"exposure", kExposure_us}, {"noise_filtering", 0}},
          {"mono8", "bgr8"},
          "",
          "--config " FAST_EDI_SOURCE_DIR "/cfg/dv_ros.yaml exposure_time_us:=" +
              std::to_string(kExposure_us),
          "/dvs/capture_node/camera/deblurred"};
}

DriverCase driverCase(const std::string& name) {
  if (name == "davis_ros_driver") {
    return davisRosDriverCase();
  }
  if (name == "dv_ros") {
    return dvRosCase();
  }
  throw std::invalid_argument("expected davis_ros_driver or dv_ros, got " + name);
}

std::unique_ptr<DriverCase> driver;  // set by main

TEST(DriverLaunch, SetsUpTheDriverOnceItSends) {
  std::map<std::string, std::string> types;
  for (const auto& setting : driver->expected_settings) {
    const bool is_number = setting.first == "streaming_rate" || setting.first == "exposure";
    types[setting.first] = is_number ? "int" : "bool";
  }
  NodeClient client("/dvs", "/dvs/deblur", "deblurred", driver->shape.topics);
  FakeDriver server(driver->shape.node, types);
  Arrival calibration;
  calibration.info = boost::make_shared<sensor_msgs::CameraInfo>();
  EXPECT_TRUE(waitUntil([&] {
    client.publish(calibration);
    return !server.set().empty();
  })) << "nothing was set";
  EXPECT_EQ(server.set(), driver->expected_settings);
}

TEST(DriverLaunch, DeblursRecordingsOfItsShape) {
  NodeClient client("/dvs", "/dvs/deblur", "deblurred", driver->shape.topics);
  int epoch = 0;
  for (const std::string& encoding : driver->encodings) {
    SCOPED_TRACE(encoding);
    const SimulatedRecording simulated = simulateRecording(
        FAST_EDI_TOOLS_DIR, driver->shape,
        "--width 160 --height 120 --frames 8 --density 1 --exposure-us " +
            std::to_string(kExposure_us) + " --encoding " + encoding + " " + driver->camera +
            " --start-ns " + std::to_string(1'700'000'000 + 100 * ++epoch) + "000000000");
    const TemporaryDirectory directory;
    writeBag(simulated.recording, driver->shape, directory.file("in.bag"));
    const testing::CommandResult offline = testing::runCommand(
        FAST_EDI_TOOLS_DIR "/deblur_bag --in " + directory.file("in.bag") + " --out " +
        directory.file("out.bag") + " --events " + driver->shape.topics.events + " --image " +
        driver->shape.topics.image + " --exposure " + driver->shape.topics.exposure +
        " --camera-info " + driver->shape.topics.camera_info + " " + driver->deblur_bag +
        " close_timeout_ms:=20000");
    ASSERT_EQ(offline.exit_code, 0) << offline.output;

    ASSERT_TRUE(client.listen());
    ChildProcess player(
        {"rosbag", "play", "--quiet", "--wait-for-subscribers", directory.file("in.bag")});
    EXPECT_EQ(player.wait(), 0);
    const std::vector<Output> outputs = client.waitForOutputs(simulated.truth.size());
    EXPECT_TRUE(client.stopListening());

    expectSameImages(outputs, readOutputs(directory.file("out.bag"), driver->offline_namespace));
    const std::vector<sensor_msgs::ImageConstPtr> inputs = imagesOf(simulated.recording);
    ASSERT_EQ(outputs.size(), simulated.truth.size());
    double gain_db = 0.0;
    for (std::size_t i = 0; i < outputs.size(); ++i) {
      const sensor_msgs::Image& output = *outputs[i].image;
      const sensor_msgs::Image& truth = *simulated.truth[i];
      EXPECT_EQ(output.encoding, encoding);
      EXPECT_EQ(output.header.stamp, truth.header.stamp) << "not the middle of the exposure";
      EXPECT_EQ(outputs[i].info->header.stamp, output.header.stamp);
      EXPECT_GT(outputs[i].info->K[0], 0.0) << "no calibration";
      gain_db += psnrOf(output, truth) - psnrOf(*inputs[i], truth);
    }
    EXPECT_GT(gain_db / static_cast<double>(outputs.size()), 3.0);
  }
}

/// Biases that a driver reports, and the digits that thresholds from them begin with.
struct ReportedBiases {
  Settings biases;
  std::string on;
  std::string off;
};

const ReportedBiases kReported[] = {
    {{{"DiffBn_coarse", 4},
      {"DiffBn_fine", 92},
      {"ONBn_coarse", 6},
      {"ONBn_fine", 48},
      {"OFFBn_coarse", 2},
      {"OFFBn_fine", 160},
      {"PrBp_coarse", 2},
      {"exposure", kExposure_us}},
     "0.231",
     "0.237"},
    // The defaults of davis_ros_driver, which leave the OFF threshold open.
    {{{"DiffBn_coarse", 4},
      {"DiffBn_fine", 39},
      {"ONBn_coarse", 6},
      {"ONBn_fine", 200},
      {"OFFBn_coarse", 4},
      {"OFFBn_fine", 0}},
     "0.38",
     "0.38"},
};

TEST(DriverLaunch, FollowsTheBiasesOfTheRunningDriver) {
  NodeClient client("/dvs", "/dvs/deblur", "deblurred", driver->shape.topics);
  FakeDriver server(driver->shape.node, {});
  ASSERT_TRUE(client.listen());
  for (const ReportedBiases& reported : kReported) {
    server.announce(reported.biases);
    EXPECT_TRUE(client.waitForReport([&](const diagnostic_msgs::DiagnosticStatus& status) {
      return valueOf(status, "Contrast threshold ON").rfind(reported.on, 0) == 0 &&
             valueOf(status, "Contrast threshold OFF").rfind(reported.off, 0) == 0;
    })) << valueOf(client.report(), "Contrast threshold ON")
        << " " << valueOf(client.report(), "Contrast threshold OFF");
  }
  EXPECT_TRUE(client.stopListening());
}

}  // namespace
}  // namespace test
}  // namespace fast_edi

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "driver_launch");
  if (argc < 2) {
    throw std::invalid_argument("expected the name of a driver");
  }
  fast_edi::test::driver =
      std::make_unique<fast_edi::test::DriverCase>(fast_edi::test::driverCase(argv[1]));
  const ros::NodeHandle keeps_ros_running;
  return RUN_ALL_TESTS();
}
