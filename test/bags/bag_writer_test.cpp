/// What BagWriter writes of random and damaged bags, chunk by chunk and message by message, as
/// rosbag's own reader sees it.
#include "fast_edi/bags/bag_writer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <std_msgs/Int32.h>
#include <std_msgs/String.h>
#include <boost/make_shared.hpp>

#include <sys/stat.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <random>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "fast_edi/bags/bag_error.hpp"
#include "fast_edi/bags/bag_reader.hpp"
#include "support/temporary_directory.hpp"

namespace fast_edi {
namespace {

using ::testing::HasSubstr;

using Messages = std::vector<std::pair<ros::Time, std::string>>;
/// In the order in which rosbag gives them, by topic and header of the connection.
using Bag = std::map<std::pair<std::string, ros::M_string>, Messages>;

constexpr int kBags = 20;
constexpr int kMessages = 200;
const std::string kOwnTopic = "/own";

Bag read(const std::string& path) {
  Bag messages;
  const rosbag::Bag bag(path);
  for (const rosbag::MessageInstance& message : rosbag::View(bag)) {
    std::string bytes(message.size(), '\0');
    ros::serialization::OStream stream(reinterpret_cast<std::uint8_t*>(bytes.data()),
                                       static_cast<std::uint32_t>(bytes.size()));
    message.write(stream);
    messages[{message.getTopic(), *message.getConnectionHeader()}].emplace_back(message.getTime(),
                                                                                bytes);
  }
  return messages;
}

std::size_t count(const Bag& bag) {
  std::size_t messages = 0;
  for (const auto& entry : bag) {
    messages += entry.second.size();
  }
  return messages;
}

std::string contents(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

/// Of all chunks with that compression.
std::vector<std::string> chunksOf(const std::string& path, const std::string& compression) {
  const std::string bytes = contents(path);
  const FileSource file(path);
  std::vector<std::string> chunks;
  for (const BagChunk& chunk : buildBagIndex(file, path).chunks) {
    if (chunk.compression == compression) {
      chunks.push_back(bytes.substr(chunk.offset, chunk.size));
    }
  }
  std::sort(chunks.begin(), chunks.end());
  return chunks;
}

std::string textOf(const BagMessage& message) {
  return {reinterpret_cast<const char*>(message.data), message.size};
}

boost::shared_ptr<ros::M_string> headerOf(const std::string& publisher, bool latched) {
  auto header = boost::make_shared<ros::M_string>();
  (*header)["callerid"] = publisher;
  (*header)["latching"] = latched ? "1" : "0";
  (*header)["type"] = "std_msgs/String";
  (*header)["md5sum"] = ros::message_traits::md5sum<std_msgs::String>();
  (*header)["message_definition"] = ros::message_traits::definition<std_msgs::String>();
  return header;
}

const std::map<std::string, rosbag::compression::CompressionType> kCompressions = {
    {"none", rosbag::compression::Uncompressed},
    {"bz2", rosbag::compression::BZ2},
    {"lz4", rosbag::compression::LZ4}};

class BagWriterTest : public ::testing::TestWithParam<const char*> {
 protected:
  /// Topics of one publisher and of two, latched ones, times that are equal or go back, chunks of a
  /// few messages; some with chunks of another compression.
  void makeInput(unsigned seed) {
    std::mt19937 random(seed);
    rosbag::Bag bag(input_, rosbag::bagmode::Write);
    bag.setCompression(kCompressions.at(GetParam()));
    bag.setChunkThreshold(300 + random() % 3000);
    const std::vector<std::pair<std::string, boost::shared_ptr<ros::M_string>>> connections = {
        {"/a", headerOf("/one", false)},
        {"/a", headerOf("/two", false)},
        {"/b", headerOf("/one", true)},
        {"/c", headerOf("/three", false)}};
    const bool is_mixed = random() % 3 == 0;
    std::uint32_t now = 100;
    for (int i = 0; i < kMessages; ++i) {
      if (is_mixed && i == kMessages / 2) {
        bag.setCompression(rosbag::compression::Uncompressed);
      }
      now += random() % 3;
      std_msgs::String text;
      text.data = std::to_string(i) + std::string(random() % 60, static_cast<char>(random()));
      const auto& [topic, header] = connections[random() % connections.size()];
      const std::uint32_t late = random() % 5 == 0 ? random() % 40 : 0;
      bag.write(topic, ros::Time(now - late, 0), text, header);
    }
  }

  /// Two topics with times that never go back, chunks of several compressions, and some whose last
  /// bytes are damaged, so that they are not copied.
  void makeOrderedInput(unsigned seed) {
    std::mt19937 random(seed);
    {
      rosbag::Bag bag(input_, rosbag::bagmode::Write);
      bag.setChunkThreshold(500 + random() % 2000);
      std::uint32_t now = 100;
      for (int i = 0; i < kMessages; ++i) {
        if (i % 20 == 0) {
          const bool is_other = random() % 4 == 0;
          bag.setCompression(kCompressions.at(is_other ? "none" : GetParam()));
        }
        now += random() % 2;
        std_msgs::String text;
        text.data = std::to_string(i) + std::string(random() % 60, 'x');
        bag.write(random() % 2 == 0 ? "/a" : "/b", ros::Time(now, 0), text);
      }
    }
    std::string bytes = contents(input_);
    const FileSource file(input_);
    for (const BagChunk& chunk : buildBagIndex(file, input_).chunks) {
      if (chunk.compressed() && random() % 4 == 0) {
        bytes[chunk.offset + chunk.size - 1] ^= 1;  // of a checksum
      }
    }
    std::ofstream(input_, std::ios::binary) << bytes;
  }

  /// \param most messages that are copied
  /// \return how many were
  int copy(const std::string& compression, bool by_chunks, int most = INT32_MAX) {
    BagReader reader(input_);
    BagWriter writer(output_, {input_}, compression, true);
    if (by_chunks) {
      writer.copyChunksOf(*reader.chunks());
    }
    BagMessage message;
    int copied = 0;
    while (copied < most && reader.next(message)) {
      writer.copy(message);
      read_.emplace_back(message.time, message.connection->topic,
                         std::string(reinterpret_cast<const char*>(message.data), message.size));
      std_msgs::Int32 own;
      own.data = ++copied;
      if (copied % 3 == 0) {
        writer.write(kOwnTopic, message.time, own);
      }
    }
    writer.close();
    BagReader written(output_);
    EXPECT_TRUE(written.damage().empty()) << written.damage().front().what;
    return copied;
  }

  /// Reads the output without the writer's own messages.
  Bag copied() const {
    Bag messages = read(output_);
    for (auto connection = messages.begin(); connection != messages.end();) {
      connection =
          connection->first.first == kOwnTopic ? messages.erase(connection) : std::next(connection);
    }
    return messages;
  }

  const TemporaryDirectory directory_;
  const std::string input_ = directory_.file("in.bag");
  const std::string output_ = directory_.file("out.bag");
  std::vector<std::tuple<ros::Time, std::string, std::string>> read_;
};

INSTANTIATE_TEST_SUITE_P(AllCompressions, BagWriterTest, ::testing::Values("none", "bz2", "lz4"));

TEST_P(BagWriterTest, WritesWhatTheInputHasByChunksAndByMessages) {
  for (unsigned seed = 0; seed < kBags; ++seed) {
    SCOPED_TRACE(seed);
    makeInput(seed);
    const Bag input = read(input_);
    copy(GetParam(), false);
    const Bag by_messages = read(output_);
    EXPECT_TRUE(copied() == input);
    EXPECT_EQ(count(by_messages), std::size_t{kMessages + kMessages / 3});
    copy(GetParam(), true);
    EXPECT_TRUE(read(output_) == by_messages);
    if (GetParam() != std::string("none")) {
      const std::vector<std::string> chunks = chunksOf(input_, GetParam());
      const std::vector<std::string> written = chunksOf(output_, GetParam());
      EXPECT_TRUE(std::includes(written.begin(), written.end(), chunks.begin(), chunks.end()));
      EXPECT_EQ(written.size(), chunks.size() + 1);  // that of its own messages
    }
  }
}

TEST_P(BagWriterTest, WritesOtherCompressionsAnew) {
  makeInput(1);
  const Bag input = read(input_);
  for (const auto& entry : kCompressions) {
    copy(entry.first, true);
    EXPECT_TRUE(copied() == input);
    const FileSource file(output_);
    for (const BagChunk& chunk : buildBagIndex(file, output_).chunks) {
      EXPECT_EQ(chunk.compression, entry.first);
    }
  }
}

TEST_P(BagWriterTest, EndsWhereCopyingEnds) {
  for (unsigned seed = 0; seed < kBags; ++seed) {
    SCOPED_TRACE(seed);
    makeInput(seed);
    const int most = static_cast<int>(seed) * kMessages / kBags;
    copy(GetParam(), false, most);
    const Bag by_messages = copied();
    EXPECT_EQ(count(by_messages), static_cast<std::size_t>(most));
    copy(GetParam(), true, most);
    EXPECT_TRUE(copied() == by_messages);
  }
}

TEST_P(BagWriterTest, WritesABagThatCanBeContinued) {
  makeInput(2);
  copy(GetParam(), true);
  const std::size_t before = count(read(output_));
  {
    rosbag::Bag bag(output_, rosbag::bagmode::Append);
    std_msgs::Int32 number;
    bag.write("/more", ros::Time(1000), number);
  }
  const Bag after = read(output_);
  EXPECT_EQ(count(after), before + 1);
  EXPECT_EQ(after.size(), 6u);  // connections: four, its own, and one more
}

/// rosbag's reader for Python does not sort the messages of a connection.
TEST_P(BagWriterTest, KeepsTheMessagesOfEachConnectionInOrderInTheFile) {
  for (unsigned seed = 0; seed < kBags; ++seed) {
    SCOPED_TRACE(seed);
    makeOrderedInput(seed);
    std::map<std::uint32_t, std::vector<std::string>> wanted;
    BagReader reader(input_);
    BagMessage message;
    while (reader.next(message)) {
      wanted[message.connection->id].push_back(textOf(message));
    }
    copy(GetParam(), true);
    BagReader written(output_);
    std::map<std::uint32_t, std::vector<std::string>> found;
    std::map<std::uint32_t, std::uint64_t> places;
    while (written.next(message)) {
      const std::uint32_t connection = message.connection->id;
      EXPECT_GE(message.offset, places[connection]) << message.connection->topic;
      places[connection] = message.offset;
      if (message.connection->topic != kOwnTopic) {
        found[connection].push_back(textOf(message));
      }
    }
    EXPECT_TRUE(found == wanted);
  }
}

/// All that can be read of a damaged bag is in an output that has no damage.
TEST_P(BagWriterTest, SavesWhatDamageLeaves) {
  makeInput(3);
  const std::string whole = contents(input_);
  const std::size_t index_at = whole.rfind("op=\x05") + 10;  // in the last chunk
  std::mt19937 random(5);
  constexpr int kTrials = 100;
  std::size_t whole_ones = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    SCOPED_TRACE(trial);
    std::string bytes = whole;
    const std::size_t at = 4200 + random() % (index_at - 4200);
    if (trial % 3 == 0) {
      bytes.resize(at);
    } else {
      for (std::size_t i = at; i < std::min(at + 1 + random() % 20, bytes.size()); ++i) {
        bytes[i] = static_cast<char>(random());
      }
    }
    std::ofstream(input_, std::ios::binary) << bytes;
    read_.clear();
    const int copied_messages = copy(GetParam(), true);
    std::vector<std::tuple<ros::Time, std::string, std::string>> written;
    for (const auto& [connection, messages] : copied()) {
      for (const auto& [time, text] : messages) {
        written.emplace_back(time, connection.first, text);
      }
    }
    for (auto& entry : read_) {
      std::get<0>(entry) = std::max(std::get<0>(entry), ros::TIME_MIN);
    }
    std::sort(read_.begin(), read_.end());
    std::sort(written.begin(), written.end());
    EXPECT_TRUE(written == read_);
    whole_ones += copied_messages == kMessages ? 1 : 0;
  }
  EXPECT_LT(whole_ones, std::size_t{kTrials / 2});
}

TEST_P(BagWriterTest, TakesARecordingThatWasKilled) {
  makeInput(4);
  const std::string whole = contents(input_);
  std::string killed = whole.substr(0, whole.find("op=\x07", whole.rfind("op=\x04")));
  std::ofstream(input_, std::ios::binary) << killed;
  const int copied_messages = copy(GetParam(), true);
  EXPECT_EQ(count(copied()), static_cast<std::size_t>(copied_messages));
  EXPECT_EQ(copied_messages, kMessages);
}

class BagWriterFile : public ::testing::Test {
 protected:
  BagWriter writer(bool overwrite, UnfinishedBag unfinished = UnfinishedBag::kKeep) const {
    return {path_, {directory_.file("in.bag")}, "none", overwrite, unfinished};
  }

  const TemporaryDirectory directory_;
  const std::string path_ = directory_.file("out.bag");
  const std::string active_ = path_ + ".active";
};

TEST_F(BagWriterFile, HasItsNameWhenItIsComplete) {
  {
    BagWriter bag = writer(false);
    bag.write(kOwnTopic, ros::Time(1), std_msgs::Int32());
    EXPECT_FALSE(std::filesystem::exists(path_));
    EXPECT_TRUE(std::filesystem::exists(active_));
    bag.close();
  }
  EXPECT_FALSE(std::filesystem::exists(active_));
  EXPECT_EQ(count(read(path_)), 1u);
}

TEST_F(BagWriterFile, UnfinishedIsKeptOrRemoved) {
  { writer(false).write(kOwnTopic, ros::Time(1), std_msgs::Int32()); }
  EXPECT_FALSE(std::filesystem::exists(path_));
  EXPECT_EQ(count(read(active_)), 1u);
  { writer(false, UnfinishedBag::kRemove).write(kOwnTopic, ros::Time(1), std_msgs::Int32()); }
  EXPECT_FALSE(std::filesystem::exists(active_));
}

TEST_F(BagWriterFile, IsNotReplacedUnasked) {
  writer(false).close();
  try {
    writer(false);
    FAIL() << "replaced a bag";
  } catch (const BagError& error) {
    EXPECT_THAT(error.what(), HasSubstr("--force"));
  }
  writer(true).close();
  EXPECT_THROW(BagWriter(path_, {path_}, "none", true), BagError);
}

TEST_F(BagWriterFile, ReplacesFilesAlone) {
  ASSERT_EQ(::mkfifo(path_.c_str(), S_IRWXU), 0);
  try {
    writer(true);
    FAIL() << "replaced a pipe";
  } catch (const BagError& error) {
    EXPECT_THAT(error.what(), HasSubstr(path_ + ": it is no regular file"));
  }
  EXPECT_TRUE(std::filesystem::is_fifo(path_));
}

}  // namespace
}  // namespace fast_edi
