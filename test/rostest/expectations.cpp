#include "rostest/expectations.hpp"

#include <algorithm>

#include <gtest/gtest.h>

namespace fast_edi {
namespace test {

void expectOneOutputForEachFrame(const Recording& recording, const std::vector<Output>& outputs) {
  const std::vector<sensor_msgs::ImageConstPtr> inputs = imagesOf(recording);
  ASSERT_EQ(outputs.size(), inputs.size());
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const sensor_msgs::Image& input = *inputs[i];
    const sensor_msgs::Image& image = *outputs[i].image;
    const sensor_msgs::CameraInfo& info = *outputs[i].info;
    EXPECT_EQ(image.header.stamp, input.header.stamp) << "frame " << i;
    EXPECT_EQ(image.header.frame_id,
              input.header.frame_id.empty() ? "fallback" : input.header.frame_id);
    EXPECT_EQ(image.encoding, input.encoding);
    EXPECT_EQ(image.width, input.width);
    EXPECT_EQ(image.height, input.height);
    EXPECT_EQ(image.step * image.height, image.data.size());
    EXPECT_EQ(info.header.stamp, image.header.stamp) << "frame " << i;
    EXPECT_EQ(info.header.frame_id, image.header.frame_id);
    EXPECT_EQ(info.width, input.width);
    EXPECT_EQ(info.height, input.height);
  }
}

void expectSameImages(const std::vector<Output>& outputs, const std::vector<Output>& expected) {
  ASSERT_EQ(outputs.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(outputs[i].image->header.stamp, expected[i].image->header.stamp) << "frame " << i;
    EXPECT_TRUE(outputs[i].image->data == expected[i].image->data)
        << "frame " << i << " has other pixels";
    EXPECT_EQ(outputs[i].info->K, expected[i].info->K) << "frame " << i;
  }
}

int countChanged(const Recording& recording, const std::vector<Output>& outputs) {
  const std::vector<sensor_msgs::ImageConstPtr> inputs = imagesOf(recording);
  int changed = 0;
  for (std::size_t i = 0; i < std::min(inputs.size(), outputs.size()); ++i) {
    changed += inputs[i]->data != outputs[i].image->data ? 1 : 0;
  }
  return changed;
}

}  // namespace test
}  // namespace fast_edi
