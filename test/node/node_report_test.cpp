// What a deblurring node counts, and the report that it publishes.
#include "node/node_report.hpp"

#include <string>

#include <diagnostic_msgs/DiagnosticArray.h>
#include <gmock/gmock.h>
#include <ros/callback_queue.h>
#include <ros/node_handle.h>

#include "node/diagnostic_value.hpp"
#include "rostest/node_client.hpp"
#include "rostest/ros_process.hpp"
#include "support/pipeline_input.hpp"

namespace fast_edi {
namespace {

using testing::value;

const InputTopics kTopics{"/dvs/events", "/dvs/image_raw", "/dvs/exposure",
                          "/driver/parameter_updates"};

class NodeReportTest : public ::testing::Test {
 protected:
  NodeReport report_{"/deblur", kTopics};
};

TEST_F(NodeReportTest, CountsOutputs) {
  report_.addOutput(30, 20, 10);
  report_.addOutput(60, 50, 40);
  EXPECT_EQ(report_.totals().frames_out, 2U);
}

TEST_F(NodeReportTest, KeepsTheLastRefusalOfEachKind) {
  report_.addRefusedValue("first value");
  report_.addRefusedValue("second value");
  report_.addRefusedBiases("biases");
  report_.addRefusedCameraInfo("camera_info");
  const NodeSnapshot& totals = report_.totals();
  EXPECT_EQ(totals.values_refused, 2U);
  EXPECT_EQ(totals.value_refusal, "second value");
  EXPECT_EQ(totals.bias_updates_refused, 1U);
  EXPECT_EQ(totals.bias_refusal, "biases");
  EXPECT_EQ(totals.camera_infos_refused, 1U);
  EXPECT_EQ(totals.camera_info_refusal, "camera_info");
}

TEST_F(NodeReportTest, BiasesWithoutAFaultAreNotRefused) {
  report_.addRefusedBiases("");
  EXPECT_EQ(report_.totals().bias_updates_refused, 0U);
}

TEST_F(NodeReportTest, KeepsTheLastInternalError) {
  report_.addInternalError("first", 10);
  report_.addInternalError("second", 20);
  EXPECT_EQ(report_.totals().internal_errors, 2U);
  EXPECT_EQ(report_.totals().internal_error, "second");
}

TEST_F(NodeReportTest, WhatCameBeforeListeningIsForgottenButCountsStay) {
  report_.totals().last_frame_ns = 5;
  report_.totals().last_events_ns = 6;
  report_.addOutput(9, 8, 7);
  report_.startListening(10);
  EXPECT_EQ(report_.totals().listening_since_ns, 10);
  EXPECT_EQ(report_.totals().last_frame_ns, 0);
  EXPECT_EQ(report_.totals().last_events_ns, 0);
  EXPECT_EQ(report_.totals().frames_out, 1U);
}

TEST_F(NodeReportTest, TakesOverThePipelineWithItsThresholds) {
  DeblurParameters parameters;
  parameters.thresholds = {0.31, 0.29};
  testing::RecordingSink sink;
  const Deblurrer deblurrer(parameters, sink);
  report_.setPipeline(deblurrer, "from biases", true);
  const NodeSnapshot& totals = report_.totals();
  EXPECT_TRUE(totals.listening);
  EXPECT_EQ(totals.contrast_origin, "from biases");
  EXPECT_EQ(totals.thresholds.on, 0.31);
  EXPECT_EQ(totals.thresholds.off, 0.29);
  EXPECT_EQ(totals.counters.frames_in, 0U);
}

TEST(NodeReport, IsPublishedWithLatenciesAndWhatWentWrong) {
  test::requireRos();
  ros::CallbackQueue queue;
  ros::NodeHandle nh;
  nh.setCallbackQueue(&queue);
  diagnostic_msgs::DiagnosticStatus published;
  const ros::Subscriber subscriber = nh.subscribe<diagnostic_msgs::DiagnosticArray>(
      "/diagnostics", 10, [&published](const diagnostic_msgs::DiagnosticArrayConstPtr& array) {
        for (const diagnostic_msgs::DiagnosticStatus& status : array->status) {
          if (status.name == "report_test: deblurring") {
            published = status;
          }
        }
      });
  NodeReport report("/deblur", kTopics);  // ends before its queue
  report.advertise(nh, ros::NodeHandle("/report_test"), "/report_test");
  const std::int64_t now_ns = 100 * kNanosecondsPerSecond;
  report.startListening(now_ns);
  report.totals().last_frame_ns = now_ns;
  report.totals().last_events_ns = now_ns;
  report.totals().listening = true;
  report.addOutput(now_ns, now_ns - 2 * kNanosecondsPerMillisecond,
                   now_ns - 7 * kNanosecondsPerMillisecond);
  report.addRefusedBiases("DiffBn_fine: found 300");
  ASSERT_TRUE(test::waitUntil([&] {
    if (subscriber.getNumPublishers() > 0 && published.name.empty()) {
      report.publish(now_ns);
      report.addRefusedBiases("DiffBn_fine: found 300");
    }
    queue.callAvailable(ros::WallDuration(0.01));
    return value(published, "Frames out") == "1" &&
           published.message.find("DiffBn_fine") != std::string::npos;
  })) << published.message;
  EXPECT_EQ(value(published, "Close latency p99 [ms]"), "2.000");
  EXPECT_EQ(value(published, "Image to output p99 [ms]"), "7.000");
}

}  // namespace
}  // namespace fast_edi
