#include "bags/bag_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <boost/make_shared.hpp>

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "bags/new_chunk.hpp"
#include "fast_edi/bags/bag_error.hpp"
#include "support/temporary_directory.hpp"

namespace fast_edi {
namespace {

BagConnection connectionOf(std::uint32_t id) {
  BagConnection connection;
  connection.id = id;
  connection.topic = "/topic";
  connection.header = boost::make_shared<ros::M_string>();
  (*connection.header)["type"] = "std_msgs/Int32";
  (*connection.header)["md5sum"] = "da5909fbe378aeaf85e547e830cc1bb7";
  (*connection.header)["message_definition"] = "int32 data";
  return connection;
}

NewChunk chunkOf(const BagConnection& connection, std::uint8_t number) {
  NewChunk chunk;
  chunk.add(connection);
  const std::vector<std::uint8_t> message{number, 0, 0, 0};
  chunk.add(connection.id, {number, 0}, message.data(), 4);
  return chunk;
}

void write(BagFile& file, const NewChunk& chunk) {
  file.writeChunk("none", static_cast<std::uint32_t>(chunk.bytes().size()), chunk.bytes(),
                  chunk.index());
}

class BagFileTest : public ::testing::Test {
 protected:
  const TemporaryDirectory directory_;
  const std::string path_ = directory_.file("file.bag");
  const BagConnection connection_ = connectionOf(3);
};

TEST_F(BagFileTest, IsReadByRosbag) {
  BagFile file(path_);
  write(file, chunkOf(connection_, 1));
  const NewChunk second = chunkOf(connection_, 2);
  const MemorySource source(reinterpret_cast<const std::uint8_t*>(second.bytes().data()),
                            second.bytes().size());
  BagChunk chunk;
  chunk.size = second.bytes().size();
  chunk.full_size = static_cast<std::uint32_t>(chunk.size);
  chunk.compression = "none";
  file.copyChunk(source, chunk, second.index());
  file.close({{3, connection_}});

  rosbag::Bag bag(path_);
  std::vector<ros::Time> times;
  for (const rosbag::MessageInstance& message : rosbag::View(bag)) {
    EXPECT_EQ(message.getTopic(), "/topic");
    EXPECT_EQ(*message.getConnectionHeader(), *connection_.header);
    times.push_back(message.getTime());
  }
  EXPECT_THAT(times, ::testing::ElementsAre(ros::Time(1, 0), ros::Time(2, 0)));
}

TEST_F(BagFileTest, WithoutMessagesIsReadByRosbag) {
  BagFile file(path_);
  file.close({});
  rosbag::Bag bag(path_);
  EXPECT_EQ(rosbag::View(bag).size(), 0u);
}

TEST_F(BagFileTest, HasItsChunksBeforeItIsClosed) {
  BagFile file(path_);
  write(file, chunkOf(connection_, 1));
  const FileSource source(path_);
  const BagIndex index = buildBagIndex(source, path_);
  EXPECT_EQ(index.entries.size(), 1u);
  ASSERT_EQ(index.damage.size(), 1u);
  EXPECT_THAT(index.damage.front().what, ::testing::HasSubstr("never closed"));
}

TEST_F(BagFileTest, CopiesAChunkOfManyBlocks) {
  BagConnection connection = connectionOf(0);
  NewChunk large;
  large.add(connection);
  const std::vector<std::uint8_t> message(5'000'000, 7);
  large.add(0, {1, 0}, message.data(), static_cast<std::uint32_t>(message.size()));
  const MemorySource source(reinterpret_cast<const std::uint8_t*>(large.bytes().data()),
                            large.bytes().size());
  BagChunk chunk;
  chunk.size = large.bytes().size();
  chunk.full_size = static_cast<std::uint32_t>(chunk.size);
  chunk.compression = "none";
  BagFile file(path_);
  file.copyChunk(source, chunk, large.index());
  file.close({{0, connection}});
  rosbag::Bag bag(path_);
  rosbag::View view(bag);
  ASSERT_EQ(view.size(), 1u);
  EXPECT_EQ(view.begin()->size(), message.size());
}

TEST_F(BagFileTest, SaysWhatCannotBeReadOrWritten) {
  BagChunk chunk;
  chunk.size = 10;
  chunk.compression = "none";
  const MemorySource nothing(nullptr, 0);
  BagFile file(path_);
  EXPECT_THROW(file.copyChunk(nothing, chunk, {}), BagError);
  EXPECT_THROW(BagFile("/nowhere/file.bag"), BagError);
  EXPECT_THROW(BagFile("/dev/full"), BagError);
}

}  // namespace
}  // namespace fast_edi
