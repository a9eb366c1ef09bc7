#include "bags/joined_recordings.hpp"

#include <gmock/gmock.h>
#include <rosbag/bag.h>
#include <std_msgs/Int32.h>

#include <filesystem>

#include "fast_edi/bags/bag_deserialise.hpp"
#include "fast_edi/bags/open_messages.hpp"
#include "support/temporary_directory.hpp"

namespace fast_edi {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;

/// A bag with numbers on \p topic, recorded at that many seconds.
std::string writeNumbers(const std::string& path, const std::string& topic,
                         const std::vector<int>& numbers) {
  rosbag::Bag bag(path, rosbag::bagmode::Write);
  for (const int number : numbers) {
    std_msgs::Int32 message;
    message.data = number;
    bag.write(topic, ros::Time(number), message);
  }
  return path;
}

std::vector<int> readNumbers(MessageSource& source) {
  std::vector<int> numbers;
  BagMessage message;
  while (source.next(message)) {
    EXPECT_EQ(&source.connections().at(message.connection->id), message.connection);
    numbers.push_back(deserialise<std_msgs::Int32>(message)->data);
  }
  return numbers;
}

TEST(JoinedRecordings, AreInOrderOfTheirRecordTimes) {
  const TemporaryDirectory directory;
  const std::string first = writeNumbers(directory.file("0.bag"), "/a", {1, 2, 5});
  const std::string second = writeNumbers(directory.file("1.bag"), "/a", {4, 6});
  const std::string third = writeNumbers(directory.file("2.bag"), "/b", {3, 7});
  const std::unique_ptr<MessageSource> source =
      openMessages(std::vector<std::string>{third, first, second});
  EXPECT_THAT(source->connections(), SizeIs(2));
  std::map<std::string, std::uint64_t> messages;
  for (const auto& entry : source->connections()) {
    messages[entry.second.topic] += entry.second.messages;
  }
  EXPECT_EQ(messages.at("/a"), 5u);
  EXPECT_EQ(messages.at("/b"), 2u);
  EXPECT_EQ(source->length(), 7u);
  EXPECT_THAT(readNumbers(*source), ElementsAre(1, 2, 3, 4, 5, 6, 7));
  EXPECT_EQ(source->position(), 7u);
  EXPECT_THAT(source->damage(), SizeIs(0));
}

TEST(JoinedRecordings, NameTheFileThatIsDamaged) {
  const TemporaryDirectory directory;
  const std::string first = writeNumbers(directory.file("0.bag"), "/a", {1, 2});
  const std::string second = writeNumbers(directory.file("1.bag"), "/a", {3, 4});
  std::filesystem::resize_file(second, std::filesystem::file_size(second) - 100);
  const std::unique_ptr<MessageSource> source =
      openMessages(std::vector<std::string>{first, second});
  EXPECT_THAT(readNumbers(*source), ElementsAre(1, 2, 3, 4));
  ASSERT_FALSE(source->damage().empty());
  EXPECT_THAT(source->damage()[0].what, HasSubstr("1.bag: "));
}

}  // namespace
}  // namespace fast_edi
