// A status in /diagnostics. That complaints are logged now and then only is
// throttled_warnings_test.
#include "node/report_publisher.hpp"

#include <string>

#include <diagnostic_msgs/DiagnosticArray.h>
#include <gtest/gtest.h>
#include <ros/callback_queue.h>
#include <ros/node_handle.h>

#include "node/diagnostic_value.hpp"
#include "rostest/node_client.hpp"
#include "rostest/ros_process.hpp"

namespace fast_edi {
namespace {

TEST(ReportPublisher, PublishesWhatIsFilledInUnderTheNamesOfNodeAndTask) {
  test::requireRos();
  ros::CallbackQueue queue;
  ros::NodeHandle nh;
  nh.setCallbackQueue(&queue);
  diagnostic_msgs::DiagnosticStatus published;
  const ros::Subscriber subscriber = nh.subscribe<diagnostic_msgs::DiagnosticArray>(
      "/diagnostics", 10, [&published](const diagnostic_msgs::DiagnosticArrayConstPtr& array) {
        for (const diagnostic_msgs::DiagnosticStatus& status : array->status) {
          if (status.name == "publisher_test: a task") {
            published = status;
          }
        }
      });
  ReportPublisher publisher("/publisher_test");
  int filled = 0;
  publisher.advertise(nh, ros::NodeHandle("/publisher_test"), "/publisher_test", "a task",
                      [&filled](diagnostic_updater::DiagnosticStatusWrapper& status) {
                        ++filled;
                        status.summary(diagnostic_msgs::DiagnosticStatus::WARN, "message");
                        status.add("Key", "value");
                      });
  EXPECT_TRUE(test::waitUntil([&] {
    publisher.publish({}, kNanosecondsPerSecond);
    queue.callAvailable(ros::WallDuration(0.01));
    return testing::value(published, "Key") == "value";
  }));
  EXPECT_EQ(published.level, diagnostic_msgs::DiagnosticStatus::WARN);
  EXPECT_EQ(published.message, "message");
  EXPECT_EQ(published.hardware_id, "none");
  EXPECT_GT(filled, 0);
}

}  // namespace
}  // namespace fast_edi
