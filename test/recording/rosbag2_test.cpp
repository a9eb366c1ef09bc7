/// Files that an independent library wrote from a simulated recording
/// (test/data/recordings/README.md): read, cut, damaged and put together.
#include <gmock/gmock.h>

#include <sqlite3.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

#include "fast_edi/exposure/stamp_limits.hpp"
#include "fast_edi/recording/aedat4_reader.hpp"
#include "fast_edi/recording/open_recording.hpp"
#include "fast_edi/recording/recording_error.hpp"
#include "fast_edi/recording/rosbag2_reader.hpp"
#include "recording/compared_content.hpp"
#include "support/temporary_directory.hpp"

namespace fast_edi {
namespace {

namespace fs = std::filesystem;

using ::testing::Contains;
using ::testing::Field;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;

const std::string kData = std::string(FAST_EDI_SOURCE_DIR) + "/test/data/recordings/";

using Content = testing::ComparedContent;
using EventRow = Content::EventRow;

Content readAll(Recording& recording) {
  Content content = testing::readForComparison(recording);
  EXPECT_EQ(recording.position(), recording.length());
  return content;
}

bool isAnyNoteRepeated(const std::vector<RecordingDamage>& damage) {
  std::set<std::pair<std::uint64_t, std::string>> notes;
  return !std::all_of(damage.begin(), damage.end(), [&notes](const RecordingDamage& note) {
    return notes.emplace(note.offset, note.what).second;
  });
}

Content readAll(const std::string& path) {
  const std::unique_ptr<Recording> recording = openRecording(path);
  return readAll(*recording);
}

/// What is in the recording, by the vendor's library and another format.
const Content& expectedContent() {
  static const Content content = [] {
    Aedat4Reader reader(kData + "vendor_none.aedat4");
    return readAll(reader);
  }();
  return content;
}

std::string dataFile(const std::string& folder) {
  const fs::path path = kData + "rosbag2/" + folder;
  for (const fs::directory_entry& entry : fs::directory_iterator(path)) {
    if (entry.path().filename() != "metadata.yaml") {
      return entry.path().string();
    }
  }
  throw std::runtime_error("no recording in " + path.string());
}

std::vector<char> bytesOf(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

void writeBytes(const std::string& path, const std::vector<char>& bytes) {
  std::ofstream(path, std::ios::binary)
      .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

class Rosbag2 : public ::testing::TestWithParam<const char*> {
 protected:
  TemporaryDirectory directory_;
  const std::string path_ = directory_.file("recording");
};

INSTANTIATE_TEST_SUITE_P(Kinds, Rosbag2,
                         ::testing::Values("sqlite", "sqlite_message", "sqlite_file", "mcap",
                                           "mcap_chunk", "mcap_message", "mcap_file", "big_endian",
                                           "libcaer", "libcaer_cmp", "mono", "evt3"),
                         [](const auto& kind) { return std::string(kind.param); });

TEST_P(Rosbag2, HasWhatWasRecorded) {
  const std::unique_ptr<Recording> reader = openRosbag2(kData + "rosbag2/" + GetParam());
  ASSERT_THAT(reader->streams(), SizeIs(3));
  for (const RecordedStream& stream : reader->streams()) {
    EXPECT_EQ(stream.camera, "dvs");
    if (stream.kind != StreamKind::kCalibration) {
      EXPECT_EQ(stream.size, (SensorSize{48, 40}));
    }
  }
  EXPECT_GT(reader->fileSize(), 20'000U);
  const Content content = readAll(*reader);
  EXPECT_THAT(content.damage, IsEmpty());
  EXPECT_TRUE(content.times_in_order);
  EXPECT_THAT(content.events, SizeIs(2436));
  EXPECT_EQ(content.events, expectedContent().events);
  EXPECT_EQ(content.frames, expectedContent().frames);
  EXPECT_EQ(content.calibrations, 12U);
}

TEST_P(Rosbag2, IsAlsoReadFromTheFileAlone) {
  const Content content = readAll(dataFile(GetParam()));
  EXPECT_THAT(content.damage, IsEmpty());
  EXPECT_EQ(content.events, expectedContent().events);
  EXPECT_EQ(content.frames, expectedContent().frames);
}

TEST_P(Rosbag2, GivesWhatIsLeftOfACutFileAndSaysThatItIsCut) {
  const std::vector<char> whole = bytesOf(dataFile(GetParam()));
  constexpr std::size_t kStep = 1009;
  std::size_t most_events = 0;
  for (std::size_t size = 0; size < whole.size(); size += kStep) {
    writeBytes(path_, {whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)});
    try {
      const std::unique_ptr<Recording> recording = openRecording(path_);
      if (!recording) {
        EXPECT_LT(size, 20U);
        continue;
      }
      const Content content = readAll(*recording);
      EXPECT_TRUE(content.times_in_order);
      EXPECT_THAT(content.damage, Not(IsEmpty())) << size << " of " << whole.size() << " bytes";
      EXPECT_FALSE(isAnyNoteRepeated(content.damage)) << size << " bytes";
      EXPECT_LE(content.frames.size(), 3U);
      EXPECT_LE(content.events.size(), 2436U);
      most_events = std::max(most_events, content.events.size());
    } catch (const RecordingError& error) {
      EXPECT_THAT(error.what(), HasSubstr(path_)) << size << " bytes";
    }
  }
  // A file that is compressed as a whole is one block here, of which nothing is left.
  EXPECT_EQ(most_events > 0, std::string(GetParam()).find("_file") == std::string::npos);
}

TEST_P(Rosbag2, SurvivesDamageAnywhere) {
  const std::vector<char> whole = bytesOf(dataFile(GetParam()));
  constexpr std::size_t kStep = 503;
  std::vector<char> damaged = whole;
  for (std::size_t place = 0; place < whole.size(); place += kStep) {
    damaged[place] = static_cast<char>(~whole[place]);
    writeBytes(path_, damaged);
    damaged[place] = whole[place];
    try {
      if (const std::unique_ptr<Recording> recording = openRecording(path_)) {
        EXPECT_TRUE(readAll(*recording).times_in_order) << "byte " << place;
      }
    } catch (const RecordingError& error) {
      EXPECT_THAT(error.what(), HasSubstr(path_));
    }
  }
}

class Rosbag2Folder : public ::testing::Test {
 protected:
  /// Copies a file of the test data into the folder.
  void add(const std::string& of, const std::string& name) const {
    fs::copy_file(dataFile(of), directory_.file(name));
  }
  void writeMetadata(const std::string& text) const {
    std::ofstream(directory_.file("metadata.yaml")) << "rosbag2_bagfile_information:\n" << text;
  }
  std::string folder() const { return directory_.file(""); }

  TemporaryDirectory directory_;
};

TEST_F(Rosbag2Folder, OfSeveralFilesIsReadInTheOrderOfItsMetadata) {
  add("mcap", "b.mcap");
  add("sqlite", "a.db3");
  writeMetadata("  relative_file_paths: [b.mcap, folder/a.db3]\n");
  EXPECT_EQ(formatOf(folder()), RecordingFormat::kRosbag2);
  const std::unique_ptr<Recording> reader = openRosbag2(folder());
  EXPECT_EQ(reader->format(), "rosbag2, MCAP, not compressed");
  const Content content = readAll(*reader);
  EXPECT_THAT(content.damage, IsEmpty());
  EXPECT_THAT(content.events, SizeIs(2 * 2436));
  EXPECT_THAT(content.frames, SizeIs(6));
  EXPECT_TRUE(content.times_in_order);
}

TEST_F(Rosbag2Folder, WithoutMetadataIsReadInTheOrderOfTheNumbersInItsNames) {
  add("sqlite", "r_10.db3");
  add("mcap_file", "r_2.mcap.zstd");
  const std::unique_ptr<Recording> reader = openRosbag2(folder());
  EXPECT_EQ(reader->format(), "rosbag2, MCAP, not compressed, compressed by file");
  EXPECT_THAT(readAll(*reader).events, SizeIs(2 * 2436));
}

TEST_F(Rosbag2Folder, NamesWhatIsMissing) {
  add("sqlite", "r_0.db3");
  writeMetadata("  relative_file_paths:\n  - r_0.db3\n  - r_1.db3\n  message_count: 50\n");
  const Content content = readAll(folder());
  EXPECT_THAT(content.damage,
              Contains(Field(&RecordingDamage::what, HasSubstr("r_1.db3, which is missing"))));
  EXPECT_THAT(content.damage, Contains(Field(&RecordingDamage::what,
                                             HasSubstr("31 messages are found, expected 50"))));
  EXPECT_EQ(content.events, expectedContent().events);
}

TEST_F(Rosbag2Folder, IsReadInSpiteOfMetadataThatCannotBe) {
  add("mcap", "r_0.mcap");
  for (const std::string text :
       {"  relative_file_paths: {", "  message_count: many\n", "- - -\n: : :", "  a: \"\\u\""}) {
    writeMetadata(text);
    const Content content = readAll(folder());
    EXPECT_THAT(content.damage, SizeIs(1)) << text;
    EXPECT_EQ(content.events, expectedContent().events);
  }
  writeMetadata("  a: " + std::string(1'000'000, '['));
  EXPECT_THAT(readAll(folder()).damage,
              Contains(Field(&RecordingDamage::what, HasSubstr("nested too deeply"))));
}

TEST_F(Rosbag2Folder, OfWhichOneFileIsNoRecordingGivesTheOthers) {
  add("mcap", "r_0.mcap");
  writeBytes(directory_.file("r_1.mcap"), {});
  const Content content = readAll(folder());
  EXPECT_THAT(content.damage,
              Contains(Field(&RecordingDamage::what, HasSubstr("r_1.mcap, byte 0: expected"))));
  EXPECT_EQ(content.events, expectedContent().events);
}

TEST_F(Rosbag2Folder, WithoutRecordingsIsRefused) {
  EXPECT_EQ(formatOf(folder()), RecordingFormat::kUnknown);
  EXPECT_THROW(openRosbag2(folder()), RecordingError);
  writeMetadata("  relative_file_paths: []\n");
  EXPECT_THROW(openRosbag2(folder()), RecordingError);
}

/// Runs SQL on a database.
void execute(sqlite3* database, const std::string& sql) {
  ASSERT_EQ(sqlite3_exec(database, sql.c_str(), nullptr, nullptr, nullptr), SQLITE_OK)
      << sqlite3_errmsg(database);
}

TEST_F(Rosbag2Folder, OfAnInterruptedRecorderIncludesItsLogOfWrites) {
  add("sqlite", "recorder.db3");
  sqlite3* database = nullptr;
  ASSERT_EQ(sqlite3_open(directory_.file("recorder.db3").c_str(), &database), SQLITE_OK);
  execute(database, "PRAGMA journal_mode=WAL");
  execute(database,
          "INSERT INTO messages (topic_id, timestamp, data) "
          "SELECT topic_id, timestamp + 1000000000, data FROM messages");
  // As it lies there while it records.
  const std::string found = directory_.file("found.db3");
  fs::copy_file(directory_.file("recorder.db3"), found);
  fs::copy_file(directory_.file("recorder.db3-wal"), found + "-wal");
  sqlite3_close(database);
  const Content content = readAll(found);
  EXPECT_THAT(content.damage, IsEmpty());
  EXPECT_THAT(content.events, SizeIs(2 * 2436));
  EXPECT_FALSE(fs::exists(found + "-shm"));
}

TEST_F(Rosbag2Folder, IsReadInTheOrderOfTimeWhateverTheOrderOfItsRows) {
  add("sqlite", "r.db3");
  sqlite3* database = nullptr;
  ASSERT_EQ(sqlite3_open(directory_.file("r.db3").c_str(), &database), SQLITE_OK);
  execute(database, "CREATE TABLE of_topics AS SELECT * FROM messages ORDER BY topic_id DESC");
  execute(database, "DELETE FROM messages");
  execute(database,
          "INSERT INTO messages (topic_id, timestamp, data) "
          "SELECT topic_id, timestamp, data FROM of_topics");
  sqlite3_close(database);
  const Content content = readAll(directory_.file("r.db3"));
  EXPECT_EQ(content.events, expectedContent().events);
  EXPECT_EQ(content.frames, expectedContent().frames);
}

TEST_F(Rosbag2Folder, WithOtherTablesIsRefused) {
  sqlite3* database = nullptr;
  const std::string path = directory_.file("hostile.db3");
  ASSERT_EQ(sqlite3_open(path.c_str(), &database), SQLITE_OK);
  execute(database, "CREATE TABLE topics (id, name, type, serialization_format)");
  execute(
      database,
      "CREATE VIEW messages AS WITH RECURSIVE m(id) AS (SELECT 1 UNION ALL SELECT id + 1 FROM m)"
      " SELECT id, 1 AS topic_id, id AS timestamp, 'x' AS data FROM m");
  sqlite3_close(database);
  EXPECT_THROW(openRosbag2(path), RecordingError);
}

TEST_F(Rosbag2Folder, IsSurvivedWithAnySizesInItsHeads) {
  for (const std::string kind : {"mcap", "mcap_chunk", "sqlite"}) {
    const std::vector<char> whole = bytesOf(dataFile(kind));
    const std::string path = directory_.file("hostile");
    for (const std::uint64_t size :
         {std::uint64_t{0}, std::uint64_t{0x7FFFFFFF}, ~std::uint64_t{0}}) {
      constexpr std::size_t kStep = 5;
      constexpr std::size_t kHead = 400;
      for (std::size_t place = 0; place < kHead; place += kStep) {
        std::vector<char> hostile = whole;
        std::memcpy(hostile.data() + place, &size, sizeof(size));
        writeBytes(path, hostile);
        try {
          if (const std::unique_ptr<Recording> recording = openRecording(path)) {
            EXPECT_LE(readAll(*recording).events.size(), 2436U) << kind << ", byte " << place;
          }
        } catch (const RecordingError& error) {
          EXPECT_THAT(error.what(), HasSubstr(path));
        }
      }
    }
  }
}

TEST(RealRosbag2, OfADvxplorerIsWholeAcrossTheWrapOfItsClock) {
  const char* folder = std::getenv("FAST_EDI_RECORDINGS");
  if (folder == nullptr) {
    std::cout << "FAST_EDI_RECORDINGS is not set: the package's own recordings alone\n";
    return;
  }
  const std::unique_ptr<Recording> reader = openRosbag2(std::string(folder) + "/dvxplorer_rosbag2");
  ASSERT_THAT(reader->streams(), SizeIs(1));
  EXPECT_EQ(reader->streams()[0].size, (SensorSize{640, 480}));
  const Content content = readAll(*reader);
  EXPECT_THAT(content.damage, IsEmpty());
  ASSERT_THAT(content.events, SizeIs(334'331));
  std::int64_t before_ns = std::get<0>(content.events.front());
  for (const EventRow& event : content.events) {
    const std::int64_t t_ns = std::get<0>(event);
    ASSERT_GE(t_ns, before_ns);
    ASSERT_LT(t_ns - before_ns, 100 * kNanosecondsPerMillisecond);
    before_ns = t_ns;
  }
}

}  // namespace
}  // namespace fast_edi
