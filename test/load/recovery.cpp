#include "load/recovery.hpp"

#include <vector>

#include "load/load_camera.hpp"
#include "rostest/node_client.hpp"
#include "rostest/recording.hpp"

namespace fast_edi::load {

std::string faultAfterLoad(const std::string& ns, const std::string& node) {
  test::RecordingSettings settings;
  settings.size = kSensor;
  settings.frames = 5;
  settings.start_ns = 2'000'000'000 * kNanosecondsPerSecond;  // after the load
  const test::Recording recording = test::makeRecording(settings);
  DeblurParameters parameters = test::testParameters();
  parameters.filter.enabled = false;
  const std::vector<test::Output> expected = test::deblurWithoutRos(recording, parameters);

  test::NodeClient client(ns, node);
  if (!client.listen()) {
    return "the node does not listen any more";
  }
  client.play(recording);
  const std::vector<test::Output> outputs = client.waitForOutputs(expected.size());
  if (outputs.size() != expected.size()) {
    return std::to_string(outputs.size()) + " of " + std::to_string(expected.size()) + " frames";
  }
  for (std::size_t i = 0; i < expected.size(); ++i) {
    if (outputs[i].image->header.stamp != expected[i].image->header.stamp ||
        outputs[i].image->data != expected[i].image->data) {
      return "frame " + std::to_string(i) + " is not that of a new pipeline";
    }
  }
  return {};
}

}  // namespace fast_edi::load
