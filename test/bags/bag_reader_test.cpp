#include "fast_edi/bags/bag_reader.hpp"

#include <algorithm>
#include <cstring>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <tuple>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <std_msgs/Int32.h>
#include <std_msgs/String.h>

#include "fast_edi/bags/bag_error.hpp"
#include "support/temporary_directory.hpp"

namespace fast_edi {
namespace {

using rosbag::compression::BZ2;
using rosbag::compression::LZ4;
using rosbag::compression::Uncompressed;
using testing::HasSubstr;

constexpr int kPairs = 60;
constexpr std::uint32_t kChunkThreshold = 4000;  ///< small, so that there are many chunks

struct Read {
  std::string topic;
  ros::Time time;
  std::string bytes;

  friend bool operator==(const Read& a, const Read& b) {
    return a.topic == b.topic && a.time == b.time && a.bytes == b.bytes;
  }
};

void PrintTo(const Read& read, std::ostream* out) {
  *out << read.topic << " at " << read.time << " with " << read.bytes.size() << " bytes";
}

/// Text that does not compress to nothing, so that compressed chunks are worth cutting.
std::string noise(int seed, std::size_t size) {
  std::mt19937 random(static_cast<unsigned>(seed));
  std::string text(size, ' ');
  for (char& letter : text) {
    letter = static_cast<char>('a' + random() % 26);
  }
  return text;
}

ros::Time at(int tick) {
  ros::Time time;
  return time.fromNSec(1'000'000'000ULL + static_cast<std::uint64_t>(tick) * 10'000'000ULL);
}

/// Strings and numbers in turn; every seventh string is recorded late, out of order.
void writeMessages(rosbag::Bag& bag) {
  for (int i = 0; i < kPairs; ++i) {
    std_msgs::String text;
    text.data = noise(i, 300 + 10 * static_cast<std::size_t>(i % 13));
    bag.write("/text", at(i % 7 == 0 ? i - 3 : i), text);
    std_msgs::Int32 number;
    number.data = i;
    bag.write("/number", at(i), number);
  }
}

std::string makeBag(const TemporaryDirectory& directory, rosbag::CompressionType compression) {
  const std::string path = directory.file("whole.bag");
  rosbag::Bag bag(path, rosbag::bagmode::Write);
  bag.setCompression(compression);
  bag.setChunkThreshold(kChunkThreshold);
  writeMessages(bag);
  bag.close();
  return path;
}

std::vector<Read> readAll(BagReader& reader) {
  std::vector<Read> all;
  BagMessage message;
  while (reader.next(message)) {
    all.push_back({message.connection->topic, message.time,
                   std::string(reinterpret_cast<const char*>(message.data), message.size)});
  }
  return all;
}

std::vector<Read> readAll(const std::string& path) {
  BagReader reader(path);
  return readAll(reader);
}

/// The same with rosbag's own reader.
std::vector<Read> viewAll(const std::string& path) {
  std::vector<Read> all;
  rosbag::Bag bag(path);
  for (const rosbag::MessageInstance& message : rosbag::View(bag)) {
    std::string bytes(message.size(), '\0');
    ros::serialization::OStream stream(reinterpret_cast<std::uint8_t*>(bytes.data()),
                                       static_cast<std::uint32_t>(bytes.size()));
    message.write(stream);
    all.push_back({message.getTopic(), message.getTime(), bytes});
  }
  return all;
}

std::string contents(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

void write(const std::string& path, const std::string& bytes) {
  std::ofstream file(path, std::ios::binary);
  file << bytes;
}

/// How many of \p some are in \p all, each once.
std::size_t countIn(const std::vector<Read>& all, const std::vector<Read>& some) {
  return static_cast<std::size_t>(std::count_if(some.begin(), some.end(), [&](const Read& read) {
    return std::find(all.begin(), all.end(), read) != all.end();
  }));
}

bool less(const Read& a, const Read& b) {
  return std::tie(a.time, a.topic, a.bytes) < std::tie(b.time, b.topic, b.bytes);
}

class BagReaderTest : public testing::TestWithParam<rosbag::CompressionType> {
 protected:
  TemporaryDirectory directory_;
};

INSTANTIATE_TEST_SUITE_P(AllCompressions, BagReaderTest, testing::Values(Uncompressed, BZ2, LZ4));

TEST_P(BagReaderTest, ReadsAnIntactBagAsRosbagDoes) {
  const std::string path = makeBag(directory_, GetParam());
  BagReader reader(path);
  std::vector<Read> ours = readAll(reader);
  std::vector<Read> theirs = viewAll(path);
  EXPECT_TRUE(std::is_sorted(ours.begin(), ours.end(),
                             [](const Read& a, const Read& b) { return a.time < b.time; }));
  // Of equal times rosbag::View has no stated order; ours is the file's.
  std::sort(ours.begin(), ours.end(), less);
  std::sort(theirs.begin(), theirs.end(), less);
  EXPECT_EQ(ours, theirs);
  EXPECT_EQ(ours.size(), 2u * kPairs);
  EXPECT_TRUE(reader.damage().empty());
  EXPECT_EQ(reader.messageCount(), 2u * kPairs);
  EXPECT_EQ(reader.connections().size(), 2u);
  for (const auto& entry : reader.connections()) {
    EXPECT_EQ(entry.second.messages, static_cast<std::uint64_t>(kPairs));
  }
}

TEST_P(BagReaderTest, KeepsTheFilesOrderWhereTimesAreEqual) {
  const std::string path = directory_.file("equal.bag");
  {
    rosbag::Bag bag(path, rosbag::bagmode::Write);
    bag.setCompression(GetParam());
    for (int i = 0; i < 10; ++i) {
      std_msgs::Int32 number;
      number.data = i;
      bag.write(i % 2 == 0 ? "/even" : "/odd", at(1), number);
    }
  }
  const std::vector<Read> all = readAll(path);
  ASSERT_EQ(all.size(), 10u);
  for (std::size_t i = 0; i < all.size(); ++i) {
    std::int32_t number = 0;
    std::memcpy(&number, all[i].bytes.data(), sizeof(number));
    EXPECT_EQ(number, static_cast<std::int32_t>(i));
  }
}

TEST_P(BagReaderTest, ReadsWhatIsThereOfABagCutAnywhere) {
  const std::string path = makeBag(directory_, GetParam());
  const std::string whole = contents(path);
  const std::vector<Read> all = readAll(path);
  const FileSource file(path);
  const BagIndex index = buildBagIndex(file, path);
  const std::string cut_path = directory_.file("cut.bag");
  constexpr std::size_t kFirstRecords = 13 + 4200;  // version line and padded file header
  constexpr std::size_t kStep = 211;
  for (std::size_t size = kFirstRecords; size < whole.size(); size += kStep) {
    write(cut_path, whole.substr(0, size));
    BagReader reader(cut_path);
    const std::vector<Read> read = readAll(reader);
    EXPECT_FALSE(reader.damage().empty()) << "cut at " << size;
    EXPECT_EQ(countIn(all, read), read.size()) << "cut at " << size;
    std::size_t expected = 0;
    std::vector<std::uint8_t> scratch;
    for (const BagIndexEntry& entry : index.entries) {
      const BagChunk& chunk = index.chunks[entry.chunk];
      std::uint64_t end = chunk.offset + chunk.size;
      if (!chunk.compressed()) {
        end = readRecord(file, chunk.offset + entry.offset, scratch)->end();
      }
      expected += end <= size ? 1 : 0;
    }
    EXPECT_EQ(read.size(), expected) << "cut at " << size;
  }
}

TEST_P(BagReaderTest, GoesOnBehindADamagedChunkHeader) {
  const std::string path = makeBag(directory_, GetParam());
  std::string bytes = contents(path);
  const std::vector<Read> all = readAll(path);
  const FileSource file(path);
  const BagIndex index = buildBagIndex(file, path);
  ASSERT_GT(index.chunks.size(), 3u);
  const std::uint32_t damaged = 2;
  constexpr std::size_t kHeaderTail = 8;
  std::fill_n(bytes.begin() + static_cast<long>(index.chunks[damaged].offset) - kHeaderTail,
              kHeaderTail, '\xff');
  const auto lost = static_cast<std::size_t>(
      std::count_if(index.entries.begin(), index.entries.end(),
                    [&](const BagIndexEntry& entry) { return entry.chunk == damaged; }));
  const std::string damaged_path = directory_.file("damaged.bag");
  write(damaged_path, bytes);
  BagReader reader(damaged_path);
  const std::vector<Read> read = readAll(reader);
  EXPECT_FALSE(reader.damage().empty());
  EXPECT_EQ(countIn(all, read), read.size());
  EXPECT_GE(read.size(), all.size() - lost);
}

TEST_P(BagReaderTest, SurvivesAnyDamage) {
  const std::string path = makeBag(directory_, GetParam());
  const std::string whole = contents(path);
  const std::string damaged_path = directory_.file("damaged.bag");
  std::mt19937 random(7);
  constexpr int kTrials = 150;
  std::size_t total = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    std::string bytes = whole;
    const std::size_t first = 4300 + random() % (bytes.size() - 4300);
    const std::size_t count = std::min<std::size_t>(1 + random() % 40, bytes.size() - first);
    for (std::size_t i = 0; i < count; ++i) {
      bytes[first + i] = static_cast<char>(random());
    }
    write(damaged_path, bytes);
    const std::vector<Read> read = readAll(damaged_path);
    // A length of a chunk or a message that is damaged loses the rest of a chunk, no more.
    EXPECT_GE(read.size(), static_cast<std::size_t>(kPairs)) << "at " << first;
    total += read.size();
  }
  // There are eleven chunks, and a trial seldom hits two.
  EXPECT_GT(total, kTrials * 2u * kPairs * 8 / 10);
}

TEST_P(BagReaderTest, ReadsARecordingThatWasKilled) {
  const std::string path = directory_.file("killed.bag.active");
  const std::string copy = directory_.file("copy.bag");
  rosbag::Bag bag(path, rosbag::bagmode::Write);
  bag.setCompression(GetParam());
  bag.setChunkThreshold(kChunkThreshold);
  writeMessages(bag);
  std_msgs::Int32 last;
  bag.write("/number", at(kPairs), last);  // begins a chunk or goes into the open one
  write(copy, contents(path));
  bag.close();
  const std::vector<Read> all = readAll(path);
  BagReader reader(copy);
  const std::vector<Read> read = readAll(reader);
  EXPECT_EQ(countIn(all, read), read.size());
  EXPECT_GT(read.size(), 2u * kPairs * 8 / 10);
  ASSERT_FALSE(reader.damage().empty());
  EXPECT_THAT(reader.damage().back().what, HasSubstr("never closed"));
}

TEST(BagReaderErrorTest, NamesWhatIsNoBag) {
  const TemporaryDirectory directory;
  const std::string path = directory.file("text.bag");
  write(path, "not a bag");
  try {
    const BagReader reader(path);
    FAIL() << "read a text file as a bag";
  } catch (const BagError& error) {
    EXPECT_THAT(error.what(), HasSubstr(path));
    EXPECT_THAT(error.what(), HasSubstr("no bag"));
  }
  write(path, "#ROSBAG V1.2\nwhatever");
  EXPECT_THROW(BagReader{path}, BagError);
  EXPECT_THROW(BagReader{directory.file("missing.bag")}, BagError);
  EXPECT_THROW(BagReader{directory.file("")}, BagError);
  write(path, "");
  EXPECT_THROW(BagReader{path}, BagError);
}

TEST(BagReaderErrorTest, ReadsABagWithoutMessages) {
  const TemporaryDirectory directory;
  const std::string path = directory.file("empty.bag");
  rosbag::Bag(path, rosbag::bagmode::Write).close();
  BagReader reader(path);
  EXPECT_TRUE(readAll(reader).empty());
  // rosbag writes an index position also when there is nothing to index.
  EXPECT_TRUE(reader.damage().empty());
}

TEST(BagReaderDamage, LeavesRecordTimesThatCanBeUsed) {
  const TemporaryDirectory directory;
  std::string bytes = contents(makeBag(directory, Uncompressed));
  // Without its index the times are those of the messages.
  bytes.resize(bytes.rfind("op=\x07"));
  const std::string field = "time=";
  std::size_t at = bytes.find(field, bytes.find("op=\x05"));
  for (int damaged = 0; damaged < 3; ++damaged) {
    std::fill_n(bytes.begin() + static_cast<long>(at + field.size()), 8, '\xff');
    at = bytes.find(field, at + 1);
  }
  // Index records behind the chunks would tell the old times.
  for (at = bytes.find("op=\x04"); at != std::string::npos; at = bytes.find("op=\x04", at)) {
    bytes[at + 3] = '\x7f';
  }
  const std::string path = directory.file("damaged.bag");
  write(path, bytes);
  BagReader reader(path);
  EXPECT_EQ(reader.duration(), ros::DURATION_MAX);
  const std::vector<Read> read = readAll(reader);
  ASSERT_GT(read.size(), 3u);
  EXPECT_EQ(read.back().time, ros::Time(UINT32_MAX, 999'999'999));
}

TEST(ChunkDecompression, SaysThatLessIsThereThanStated) {
  // An empty bzip2 stream.
  const std::vector<std::uint8_t> empty{'B',  'Z',  'h',  '9', 0x17, 0x72, 0x45,
                                        0x38, 0x50, 0x90, 0,   0,    0,    0};
  for (const std::size_t stated : {std::size_t{1}, std::size_t{0xffff'ffff}}) {
    const ChunkBytes chunk = decompressChunk("bz2", empty.data(), empty.size(), stated);
    EXPECT_EQ(chunk.size, 0u);
    EXPECT_FALSE(chunk.complete);
  }
  EXPECT_TRUE(decompressChunk("bz2", empty.data(), empty.size(), 0).complete);
}

}  // namespace
}  // namespace fast_edi
