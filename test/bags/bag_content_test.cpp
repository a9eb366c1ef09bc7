#include "bags/bag_content.hpp"

#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <std_msgs/Int32.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "fast_edi/bags/bag_reader.hpp"
#include "support/temporary_directory.hpp"

namespace fast_edi {
namespace {

TEST(BagContent, CopiesChunksOfItsCompressionAlone) {
  const TemporaryDirectory directory;
  const std::string input = directory.file("in.bag");
  {
    rosbag::Bag bag(input, rosbag::bagmode::Write);
    for (int i = 1; i <= 4; ++i) {
      if (i % 2 == 1) {
        bag.setCompression(i == 1 ? rosbag::compression::LZ4 : rosbag::compression::BZ2);
      }
      std_msgs::Int32 number;
      number.data = i;
      bag.write("/number", ros::Time(i), number);
    }
  }
  const std::string output = directory.file("out.bag");
  BagReader reader(input);
  BagContent content(output, "lz4");
  content.copyChunksOf(*reader.chunks());
  BagMessage message;
  while (reader.next(message)) {
    content.copy(message);
  }
  content.close();

  const FileSource file(output);
  const BagIndex index = buildBagIndex(file, output);
  EXPECT_TRUE(index.damage.empty());
  ASSERT_EQ(index.chunks.size(), 2u);
  EXPECT_EQ(index.chunks[0].compression, "lz4");
  EXPECT_EQ(index.chunks[1].compression, "lz4");
  EXPECT_EQ(index.entries.size(), 4u);
  rosbag::Bag bag(output);
  int expected = 1;
  for (const rosbag::MessageInstance& instance : rosbag::View(bag)) {
    EXPECT_EQ(instance.instantiate<std_msgs::Int32>()->data, expected);
    ++expected;
  }
  EXPECT_EQ(expected, 5);
}

TEST(BagContent, PutsTimesRightThatRosbagRefuses) {
  const TemporaryDirectory directory;
  const std::string output = directory.file("out.bag");
  BagContent content(output, "none");
  BagConnection connection;
  connection.topic = "/number";
  connection.datatype = "std_msgs/Int32";
  connection.md5sum = "da5909fbe378aeaf85e547e830cc1bb7";
  connection.definition = "int32 data";
  const std::vector<std::uint8_t> bytes(4);
  content.write(connection, ros::Time(0, 0), bytes.data(), 4);
  content.close();
  rosbag::Bag bag(output);
  rosbag::View view(bag);
  ASSERT_EQ(view.size(), 1u);
  EXPECT_EQ(view.begin()->getTime(), ros::TIME_MIN);
}

}  // namespace
}  // namespace fast_edi
