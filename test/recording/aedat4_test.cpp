/// Files that Aedat4Writer wrote, read back, cut and damaged. Files of the vendor's library are in
/// vendor_files_test.cpp.
#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "fast_edi/exposure/stamp_limits.hpp"
#include "fast_edi/recording/aedat4_reader.hpp"
#include "fast_edi/recording/aedat4_writer.hpp"
#include "fast_edi/recording/recording_error.hpp"
#include "recording/compared_content.hpp"
#include "support/temporary_directory.hpp"

namespace fast_edi {
namespace {

constexpr SensorSize kSize{16, 12};
constexpr std::int64_t kStart_ns = 1'700'000'000'000'000'000;
constexpr std::int64_t kMillisecond = kNanosecondsPerMillisecond;

const std::vector<RecordedStream>& cameraStreams() {
  static const std::vector<RecordedStream> streams = {
      {StreamKind::kEvents, "events", "DAVIS346_1", kSize},
      {StreamKind::kFrames, "frames", "DAVIS346_1", kSize},
      {StreamKind::kImu, "imu", "DAVIS346_1", {}},
      {StreamKind::kTriggers, "triggers", "DAVIS346_1", {}}};
  return streams;
}

using Content = testing::ComparedContent;
using EventRow = Content::EventRow;
using FrameRow = Content::FrameRow;

Content readAll(const std::string& path) {
  Aedat4Reader reader(path);
  return testing::readForComparison(reader);
}

std::vector<char> bytesOf(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

void writeBytes(const std::string& path, const std::vector<char>& bytes) {
  std::ofstream(path, std::ios::binary)
      .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

std::vector<Event> someEvents(int packet, int count) {
  std::vector<Event> events;
  for (int i = 0; i < count; ++i) {
    events.push_back({static_cast<std::uint16_t>((packet + i) % kSize.width),
                      static_cast<std::uint16_t>(i % kSize.height),
                      kStart_ns + packet * 10 * kMillisecond + i * kNanosecondsPerMicrosecond,
                      i % 3 == 0});
  }
  return events;
}

RecordedFrame frameAt(std::int64_t start_ns, const std::string& encoding,
                      const std::vector<std::uint8_t>& pixels) {
  RecordedFrame frame;
  frame.exposure = ExposureInterval{start_ns, start_ns + 4773 * kNanosecondsPerMicrosecond};
  frame.stamp_ns = frame.exposure->at(ExposureInstant::kMid);
  frame.size = kSize;
  frame.encoding = encoding;
  frame.pixels = pixels.data();
  frame.bytes = pixels.size();
  return frame;
}

/// Five packets of events with a frame, an IMU sample and a trigger between them.
void writeRecording(const std::string& path, Aedat4Compression compression, int events = 100) {
  Aedat4Writer writer(path, cameraStreams(), compression, true);
  std::vector<std::uint8_t> pixels(kSize.pixelCount());
  for (int packet = 0; packet < 5; ++packet) {
    const std::vector<Event> some = someEvents(packet, events);
    writer.write({0, 0, RecordedEvents{some.data(), some.size()}});
    if (packet == 2) {
      pixels.assign(pixels.size(), 77);
      writer.write({1, 0, frameAt(kStart_ns + 15 * kMillisecond, "mono8", pixels)});
    }
    writer.write({2, 0, RecordedImu{kStart_ns + packet * kMillisecond, {0, 0, 9.8}, {1, 2, 3}}});
    writer.write({3, 0, RecordedTrigger{kStart_ns + packet * kMillisecond, 8 + packet % 2}});
  }
  writer.close();
}

/// Offset of the first packet.
std::size_t firstPacket(const std::vector<char>& bytes) {
  std::uint32_t header_bytes = 0;
  constexpr std::size_t kHeader = sizeof(Aedat4Reader::kMagic) - 1;
  std::memcpy(&header_bytes, bytes.data() + kHeader, sizeof(header_bytes));
  return kHeader + sizeof(header_bytes) + header_bytes;
}

/// The next place to damage: each byte but those of the long description of the streams, most of
/// which are alike.
std::size_t placeAfter(std::size_t place, std::size_t first_packet) {
  constexpr std::size_t kDescription = 100;
  constexpr std::size_t kStep = 97;
  return place > kDescription && place + kStep < first_packet ? place + kStep : place + 1;
}

class Aedat4 : public ::testing::TestWithParam<Aedat4Compression> {
 protected:
  TemporaryDirectory directory_;
  const std::string path_ = directory_.file("recording");
};

INSTANTIATE_TEST_SUITE_P(Compressions, Aedat4,
                         ::testing::Values(Aedat4Compression::kNone, Aedat4Compression::kLz4,
                                           Aedat4Compression::kZstd));

TEST_P(Aedat4, ReadsWhatWasWritten) {
  writeRecording(path_, GetParam());
  const Content content = readAll(path_);
  EXPECT_TRUE(content.damage.empty());
  EXPECT_TRUE(content.times_in_order);
  ASSERT_EQ(content.events.size(), 500U);
  std::size_t i = 0;
  for (int packet = 0; packet < 5; ++packet) {
    for (const Event& event : someEvents(packet, 100)) {
      EXPECT_EQ(content.events[i++], EventRow(event.t_ns, event.x, event.y, event.on));
    }
  }
  ASSERT_EQ(content.frames.size(), 1U);
  EXPECT_EQ(content.frames[0],
            FrameRow(kStart_ns + 15 * kMillisecond, kStart_ns + 19'773'000, "mono8",
                     std::vector<std::uint8_t>(kSize.pixelCount(), 77)));
  EXPECT_EQ(content.samples.size(), 5U);
  EXPECT_EQ(content.triggers, (std::vector<int>{8, 9, 8, 9, 8}));
}

TEST_P(Aedat4, TellsItsStreams) {
  writeRecording(path_, GetParam());
  const Aedat4Reader reader(path_);
  ASSERT_EQ(reader.streams().size(), 4U);
  EXPECT_EQ(reader.streams()[0].kind, StreamKind::kEvents);
  EXPECT_EQ(reader.streams()[0].size, kSize);
  EXPECT_EQ(reader.streams()[1].name, "frames");
  EXPECT_EQ(reader.streams()[1].camera, "DAVIS346_1");
  EXPECT_TRUE(reader.knowsExposures());
  EXPECT_FALSE(reader.biases());
}

TEST_P(Aedat4, EventsBeyondOnePacketAreSplit) {
  const int many = static_cast<int>(Aedat4Writer::kPacketEvents) + 1;
  writeRecording(path_, GetParam(), many);
  const Content content = readAll(path_);
  EXPECT_TRUE(content.damage.empty());
  EXPECT_EQ(content.events.size(), 5U * static_cast<std::size_t>(many));
}

/// What is there before the cut is read, and the cut is told; never more than that.
TEST_P(Aedat4, CutAnywhere) {
  writeRecording(path_, GetParam(), 20);
  const Content whole = readAll(path_);
  const std::vector<char> bytes = bytesOf(path_);
  const std::string cut_path = directory_.file("cut");
  std::size_t most = 0;
  for (std::size_t size = 0; size < bytes.size(); size = placeAfter(size, firstPacket(bytes))) {
    writeBytes(cut_path, {bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size)});
    try {
      const Content cut = readAll(cut_path);
      EXPECT_FALSE(cut.damage.empty()) << size;
      ASSERT_LE(cut.events.size(), whole.events.size()) << size;
      EXPECT_TRUE(std::equal(cut.events.begin(), cut.events.end(), whole.events.begin())) << size;
      EXPECT_GE(cut.events.size(), most) << size;
      most = cut.events.size();
    } catch (const RecordingError& error) {
      EXPECT_EQ(most, 0U) << error.what();
      EXPECT_NE(std::string(error.what()).find("byte"), std::string::npos) << error.what();
    }
  }
  EXPECT_EQ(most, whole.events.size());
}

/// Nothing but RecordingError leaves the reader, and no byte beyond the buffers is read (the
/// sanitizers see to that).
TEST_P(Aedat4, AnyByteDamaged) {
  writeRecording(path_, GetParam(), 5);
  const std::vector<char> bytes = bytesOf(path_);
  const std::string damaged_path = directory_.file("damaged");
  std::size_t refused = 0;
  for (std::size_t i = 0; i < bytes.size(); i = placeAfter(i, firstPacket(bytes))) {
    std::vector<char> damaged = bytes;
    damaged[i] = static_cast<char>(~damaged[i]);
    writeBytes(damaged_path, damaged);
    try {
      const Content content = readAll(damaged_path);
      EXPECT_LE(content.events.size(), 25U) << i;
    } catch (const RecordingError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 0U);
  EXPECT_LT(refused, bytes.size() / 2);
}

TEST_P(Aedat4, GoesOnBehindADamagedPacketHeader) {
  writeRecording(path_, GetParam());
  std::vector<char> bytes = bytesOf(path_);
  const std::size_t first = firstPacket(bytes);
  const std::int32_t hostile = 0x7FFFFFFF;
  std::memcpy(bytes.data() + first + sizeof(hostile), &hostile, sizeof(hostile));
  writeBytes(path_, bytes);
  const Content content = readAll(path_);
  EXPECT_EQ(content.events.size(), 400U);
  EXPECT_EQ(content.frames.size(), 1U);
  ASSERT_EQ(content.damage.size(), 1U);
  EXPECT_EQ(content.damage[0].offset, first);
  EXPECT_NE(content.damage[0].what.find("2147483647 bytes"), std::string::npos);
}

/// As scripts write: all events first, then all frames. Frames must come among their events.
TEST_P(Aedat4, StreamsBehindEachOtherAreMergedByTime) {
  {
    Aedat4Writer writer(path_, cameraStreams(), GetParam(), true);
    for (int packet = 0; packet < 100; ++packet) {
      const std::vector<Event> events = someEvents(packet, 10);
      writer.write({0, 0, RecordedEvents{events.data(), events.size()}});
    }
    const std::vector<std::uint8_t> pixels(kSize.pixelCount(), 1);
    for (int frame = 0; frame < 10; ++frame) {
      writer.write({1, 0, frameAt(kStart_ns + frame * 100 * kMillisecond, "mono8", pixels)});
    }
    writer.close();
  }
  Aedat4Reader reader(path_);
  RecordingItem item;
  std::vector<std::size_t> order;
  while (reader.next(item)) {
    order.push_back(item.stream);
  }
  ASSERT_EQ(order.size(), 110U);
  for (std::size_t frame = 0; frame < 10; ++frame) {
    EXPECT_EQ(order[frame * 11 + 1], 1U) << frame;
  }
}

TEST_P(Aedat4, FramesOfAllFormats) {
  const std::vector<std::pair<std::string, std::size_t>> formats = {
      {"mono8", 1}, {"mono16", 2}, {"bgr8", 3}, {"bgra8", 4}};
  {
    Aedat4Writer writer(path_, cameraStreams(), GetParam(), true);
    for (const auto& [encoding, bytes] : formats) {
      const std::vector<std::uint8_t> pixels(kSize.pixelCount() * bytes, 5);
      writer.write({1, 0, frameAt(kStart_ns, encoding, pixels)});
    }
    writer.close();
  }
  const Content content = readAll(path_);
  ASSERT_EQ(content.frames.size(), formats.size());
  for (std::size_t i = 0; i < formats.size(); ++i) {
    EXPECT_EQ(std::get<2>(content.frames[i]), formats[i].first);
    EXPECT_EQ(std::get<3>(content.frames[i]).size(), kSize.pixelCount() * formats[i].second);
  }
}

TEST(Aedat4Writer, TurnsRedFirstToBlueFirst) {
  const TemporaryDirectory directory;
  const std::string path = directory.file("recording");
  std::vector<std::uint8_t> pixels(kSize.pixelCount() * 3, 0);
  pixels[0] = 200;
  Aedat4Writer writer(path, cameraStreams(), Aedat4Compression::kNone, false);
  writer.write({1, 0, frameAt(kStart_ns, "rgb8", pixels)});
  writer.close();
  const Content content = readAll(path);
  ASSERT_EQ(content.frames.size(), 1U);
  EXPECT_EQ(std::get<2>(content.frames[0]), "bgr8");
  EXPECT_EQ(std::get<3>(content.frames[0])[2], 200);
}

TEST(Aedat4Writer, ReplacesNothingUnasked) {
  const TemporaryDirectory directory;
  const std::string path = directory.file("recording");
  writeRecording(path, Aedat4Compression::kNone);
  EXPECT_THROW(Aedat4Writer(path, cameraStreams(), Aedat4Compression::kNone, false),
               RecordingError);
  EXPECT_THROW(Aedat4Writer(directory.file("no/such/folder"), cameraStreams(),
                            Aedat4Compression::kNone, false),
               RecordingError);
}

TEST(Aedat4Writer, HasItsNameOnlyWhenComplete) {
  const TemporaryDirectory directory;
  const std::string path = directory.file("recording");
  {
    Aedat4Writer writer(path, cameraStreams(), Aedat4Compression::kNone, false);
    const std::vector<Event> events = someEvents(0, 10);
    writer.write({0, 0, RecordedEvents{events.data(), events.size()}});
  }
  EXPECT_THROW(Aedat4Reader{path}, RecordingError);
  // Without a data table, as a recording that was interrupted.
  const Content content = readAll(path + ".active");
  EXPECT_EQ(content.events.size(), 10U);
  EXPECT_TRUE(content.damage.empty());
}

TEST(Aedat4Reader, RefusesWhatItCannotRead) {
  const TemporaryDirectory directory;
  const std::string path = directory.file("recording");
  EXPECT_THROW(Aedat4Reader{path}, RecordingError);
  for (const std::string text : {"", "#!AER-DAT4.0\r\n", "#!AER-DAT2.0\r\n"}) {
    writeBytes(path, {text.begin(), text.end()});
    try {
      const Aedat4Reader reader(path);
      FAIL() << text;
    } catch (const RecordingError& error) {
      EXPECT_NE(std::string(error.what()).find(path), std::string::npos);
      EXPECT_NE(std::string(error.what()).find("expected"), std::string::npos);
    }
  }
}

}  // namespace
}  // namespace fast_edi
