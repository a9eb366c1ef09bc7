// The messages of a rosbag2 before anything is read from them.
#include "recording/rosbag2_messages.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "fast_edi/recording/recording_error.hpp"
#include "support/temporary_directory.hpp"

namespace fast_edi {
namespace {

namespace fs = std::filesystem;

using ::testing::ElementsAre;
using ::testing::Field;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

const std::string kData = std::string(FAST_EDI_SOURCE_DIR) + "/test/data/recordings/rosbag2/";
constexpr std::size_t kMessages = 31;  // says its metadata.yaml

/// Record times of all messages that are left.
std::vector<std::int64_t> readTimes(Rosbag2Messages& messages) {
  std::vector<std::int64_t> times;
  Rosbag2Message message;
  while (messages.next(message)) {
    times.push_back(message.record_ns);
  }
  return times;
}

TEST(Rosbag2Messages, AreReadToTheEndInTheOrderOfTime) {
  Rosbag2Messages messages(kData + "mcap");
  EXPECT_EQ(messages.format(), "rosbag2, MCAP, not compressed");
  EXPECT_EQ(messages.fileSize(), fs::file_size(kData + "mcap/mcap.mcap"));
  EXPECT_EQ(messages.position(), 0U);
  const std::vector<std::int64_t> times = readTimes(messages);
  EXPECT_THAT(times, SizeIs(kMessages));
  EXPECT_TRUE(std::is_sorted(times.begin(), times.end()));
  EXPECT_EQ(messages.position(), messages.length());
  EXPECT_THAT(messages.damage(), IsEmpty());
}

TEST(Rosbag2Messages, PeekingChangesNothing) {
  Rosbag2Messages messages(kData + "sqlite");
  Rosbag2Message first;
  Rosbag2Message second;
  ASSERT_TRUE(messages.peek(first));
  const std::int64_t first_ns = first.record_ns;
  ASSERT_TRUE(messages.peek(second));
  messages.rewind();
  const std::vector<std::int64_t> times = readTimes(messages);
  ASSERT_THAT(times, SizeIs(kMessages));
  EXPECT_EQ(times.front(), first_ns);
}

TEST(Rosbag2Messages, AMessageThatWasCompressedByItselfIsTheSameAsPlain) {
  Rosbag2Messages plain(kData + "mcap");
  Rosbag2Messages compressed(kData + "mcap_message");
  Rosbag2Message expected;
  Rosbag2Message found;
  std::size_t shorter = 0;
  while (plain.next(expected)) {
    ASSERT_TRUE(compressed.next(found));
    const std::size_t size = found.size;
    ASSERT_TRUE(compressed.uncompress(found));
    shorter += size < found.size ? 1 : 0;
    EXPECT_EQ(std::vector<std::uint8_t>(found.data, found.data + found.size),
              std::vector<std::uint8_t>(expected.data, expected.data + expected.size));
    EXPECT_EQ(compressed.topicOf(found).name, plain.topicOf(expected).name);
  }
  EXPECT_GT(shorter, 0U);
}

class Rosbag2MessagesOfFolder : public ::testing::Test {
 protected:
  void copy(const std::string& name) {
    fs::copy_file(kData + "mcap/mcap.mcap", folder_.file(name));
  }
  void writeNoRecording(const std::string& name) {
    std::ofstream(folder_.file(name)) << "no recording";
  }

  TemporaryDirectory folder_;
};

TEST_F(Rosbag2MessagesOfFolder, NotesNameTheFileAndTheTopic) {
  copy("a_0.mcap");
  copy("a_1.mcap");
  Rosbag2Messages messages(folder_.file(""));
  Rosbag2Message message;
  while (messages.next(message) && messages.file() == 0) {
  }
  ASSERT_EQ(messages.file(), 1U);
  messages.note(message, "odd");
  EXPECT_THAT(messages.damage(),
              ElementsAre(Field(&RecordingDamage::what,
                                "a_1.mcap: " + messages.topicOf(message).name + ": odd")));
}

TEST_F(Rosbag2MessagesOfFolder, GoOnBehindAFileThatIsNone) {
  writeNoRecording("a_0.mcap");
  copy("a_1.mcap");
  Rosbag2Messages messages(folder_.file(""));
  EXPECT_THAT(readTimes(messages), SizeIs(kMessages));
  EXPECT_THAT(messages.damage(), ElementsAre(Field(&RecordingDamage::what, HasSubstr("a_0.mcap"))));
}

TEST_F(Rosbag2MessagesOfFolder, AreRefusedWhenNoFileCanBeRead) {
  writeNoRecording("a_0.mcap");
  writeNoRecording("a_1.mcap");
  EXPECT_THROW(
      {
        try {
          Rosbag2Messages(folder_.file(""));
        } catch (const RecordingError& error) {
          EXPECT_THAT(error.what(), HasSubstr("none of its 2 files can be read"));
          throw;
        }
      },
      RecordingError);
}

TEST_F(Rosbag2MessagesOfFolder, FewerThanTheMetadataSayAreNotedOnce) {
  fs::copy_file(kData + "mcap/metadata.yaml", folder_.file("metadata.yaml"));
  // Its index and last messages are missing.
  copy("mcap.mcap");
  fs::resize_file(folder_.file("mcap.mcap"), fs::file_size(folder_.file("mcap.mcap")) / 2);
  Rosbag2Messages messages(folder_.file(""));
  const std::size_t found = readTimes(messages).size();
  ASSERT_LT(found, kMessages);
  Rosbag2Message message;
  EXPECT_FALSE(messages.next(message));
  const std::string expected = std::to_string(found) + " messages are found, expected 31";
  int notes = 0;
  for (const RecordingDamage& damage : messages.damage()) {
    notes += damage.what == expected ? 1 : 0;
  }
  EXPECT_EQ(notes, 1);
}

}  // namespace
}  // namespace fast_edi
