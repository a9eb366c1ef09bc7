// The launch file that shows images: which nodes it starts, and that they say what they lack.

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/command.hpp"

namespace fast_edi {
namespace {

using ::testing::HasSubstr;

testing::CommandResult nodesWith(const std::string& arguments) {
  return testing::runCommand("roslaunch --nodes " FAST_EDI_SOURCE_DIR "/launch/view.launch " +
                             arguments);
}

TEST(ViewLaunch, StartsOneWindowOrThree) {
  const testing::CommandResult rviz = nodesWith("");
  EXPECT_EQ(rviz.exit_code, 0) << rviz.output;
  EXPECT_THAT(rviz.output, HasSubstr("/dvs/view\n"));
  const testing::CommandResult windows = nodesWith("viewer:=image_view namespace:=cam");
  EXPECT_EQ(windows.exit_code, 0) << windows.output;
  for (const char* node : {"/cam/view_blurry", "/cam/view_deblurred", "/cam/view_comparison"}) {
    EXPECT_THAT(windows.output, HasSubstr(node));
  }
}

TEST(ViewLaunch, SaysThatAViewerIsNotInstalled) {
  const testing::CommandResult result =
      testing::runCommand(FAST_EDI_SOURCE_DIR "/launch/show_images no_such_viewer");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.output, HasSubstr("found no package no_such_viewer"));
}

}  // namespace
}  // namespace fast_edi
