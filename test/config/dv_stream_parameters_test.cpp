#include "fast_edi/config/dv_stream_parameters.hpp"

#include <string>

#include <gmock/gmock.h>

#include "fast_edi/config/parameters_from_yaml.hpp"

namespace fast_edi {
namespace {

using ::testing::HasSubstr;

std::string refusal(const std::string& yaml) {
  try {
    dvStreamParametersFromYaml(YAML::Load(yaml));
  } catch (const ParameterError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(DvStreamParametersTest, NothingGivenMeansDefaults) {
  const DvStreamParameters parameters = dvStreamParametersFromYaml(YAML::Load(""));
  EXPECT_EQ(parameters.address, "127.0.0.1");
  EXPECT_EQ(parameters.events.port, 7777);
  EXPECT_EQ(parameters.frames.port, 7778);
  EXPECT_FALSE(parameters.imu.isGiven());
  EXPECT_FALSE(parameters.triggers.isGiven());
  EXPECT_LE(parameters.max_retry_s, 1.0) << "frames are to come again within a second";
}

TEST(DvStreamParametersTest, EveryKeyIsRead) {
  const DvStreamParameters parameters = dvStreamParametersFromYaml(
      YAML::Load("{address: robot, events_port: 1, events_socket: /e, frames_port: 2, "
                 "frames_socket: /f, imu_port: 3, imu_socket: /i, triggers_port: 4, "
                 "triggers_socket: /t, stall_timeout_s: 5, max_retry_s: 6, frame_id: camera, "
                 "camera_info_file: /c.yaml}"));
  EXPECT_EQ(parameters.address, "robot");
  EXPECT_EQ(parameters.events.port, 1);
  EXPECT_EQ(parameters.events.socket, "/e");
  EXPECT_EQ(parameters.frames.port, 2);
  EXPECT_EQ(parameters.frames.socket, "/f");
  EXPECT_EQ(parameters.imu.port, 3);
  EXPECT_EQ(parameters.imu.socket, "/i");
  EXPECT_EQ(parameters.triggers.port, 4);
  EXPECT_EQ(parameters.triggers.socket, "/t");
  EXPECT_EQ(parameters.stall_timeout_s, 5.0);
  EXPECT_EQ(parameters.max_retry_s, 6.0);
  EXPECT_EQ(parameters.frame_id, "camera");
  EXPECT_EQ(parameters.camera_info_file, "/c.yaml");
  EXPECT_EQ(dvStreamDescriptions().size(), 13U) << "a key that this test does not know";
}

TEST(DvStreamParametersTest, FaultsAreNamedAllAtOnce) {
  const std::string message = refusal("{event_port: 1, frames_port: 70000, stall_timeout_s: 0}");
  EXPECT_THAT(message, HasSubstr("event_port: unknown, the nearest known key is events_port"));
  EXPECT_THAT(message, HasSubstr("frames_port: found '70000', expected an integer 0..65535"));
  EXPECT_THAT(message, HasSubstr("stall_timeout_s: found '0', expected a number 0.1..3600 [s]"));
  EXPECT_THAT(refusal("[1]"), HasSubstr("expected a map"));
  EXPECT_THAT(refusal("{events_port: 0, frames_port: 0}"),
              HasSubstr("no stream has a port or a socket"));
  EXPECT_EQ(refusal("{events_port: 0, frames_port: 0, imu_socket: /i}"), "accepted");
}

}  // namespace
}  // namespace fast_edi
