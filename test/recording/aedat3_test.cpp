/// Files made here, as cAER writes them.
#include <gmock/gmock.h>

#include <cstdint>
#include <cstring>
#include <fstream>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include "fast_edi/recording/aedat3_reader.hpp"
#include "fast_edi/recording/open_recording.hpp"
#include "fast_edi/recording/recording_error.hpp"
#include "recording/recording_content.hpp"
#include "support/temporary_directory.hpp"

namespace fast_edi {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;

constexpr std::int64_t kMicrosecond = kNanosecondsPerMicrosecond;
const std::string kHeader =
    "#!AER-DAT3.1\r\n#Format: RAW\r\n#Source 1: DAVIS346\r\n#!END-HEADER\r\n";

using EventRow = std::tuple<std::int64_t, int, int, bool>;
using Content = testing::RecordingContent;

Content readAll(const std::string& path) {
  const std::unique_ptr<Recording> reader = openAedat3(path);
  return testing::readAll(*reader);
}

template <typename Number>
void append(std::string& bytes, Number number) {
  bytes.append(reinterpret_cast<const char*>(&number), sizeof(number));
}

std::string packet(std::int16_t kind, std::int32_t event_bytes, std::int32_t overflow,
                   std::int32_t count, const std::string& events) {
  std::string bytes;
  append(bytes, kind);
  append(bytes, std::int16_t{1});
  append(bytes, event_bytes);
  append(bytes, std::int32_t{4});
  append(bytes, overflow);
  append(bytes, count);
  append(bytes, count);
  append(bytes, count);
  return bytes + events;
}

std::string event(std::uint32_t x, std::uint32_t y, bool on, std::int32_t t_us, bool valid = true) {
  std::string bytes;
  append(bytes, x << 17 | y << 2 | (on ? 2U : 0U) | (valid ? 1U : 0U));
  append(bytes, t_us);
  return bytes;
}

std::string frame(std::int32_t width, std::int32_t height, std::int32_t start_us,
                  std::int32_t end_us) {
  std::string bytes;
  append(bytes, std::uint32_t{1 | 1 << 1});  // valid, one channel
  for (const std::int32_t number :
       {start_us - 5, end_us + 5, start_us, end_us, width, height, 0, 0}) {
    append(bytes, number);
  }
  for (std::int32_t i = 0; i < width * height; ++i) {
    append(bytes, static_cast<std::uint16_t>(i * 64));
  }
  return bytes;
}

class Aedat3 : public ::testing::Test {
 protected:
  std::string write(const std::string& content) const {
    const std::string path = directory_.file("recording.aedat");
    std::ofstream(path, std::ios::binary) << content;
    return path;
  }
  const TemporaryDirectory directory_;
};

/// Two packets of events with a frame and an IMU sample between them.
std::string wholeRecording() {
  std::string sample;
  append(sample, std::uint32_t{1});
  append(sample, std::int32_t{30});
  for (const float number : {0.0F, -1.0F, 0.5F, 180.0F, 0.0F, -90.0F, 25.0F}) {
    append(sample, number);
  }
  return kHeader +
         packet(
             1, 8, 0, 3,
             event(345, 259, true, 10) + event(0, 0, false, 11, false) + event(1, 2, false, 12)) +
         packet(2, 36 + 2 * 6, 0, 1, frame(3, 2, 13, 25)) + packet(3, 36, 0, 1, sample) +
         packet(0, 8, 0, 2, std::string(16, 'x')) + packet(1, 8, 1, 1, event(7, 8, true, 5));
}

TEST_F(Aedat3, EventsFramesAndImuSamples) {
  const std::string path = write(wholeRecording());
  EXPECT_EQ(formatOf(path), RecordingFormat::kAedat3);
  const Content content = readAll(path);
  EXPECT_THAT(content.events,
              ElementsAre(EventRow(10 * kMicrosecond, 345, 259, true),
                          EventRow(12 * kMicrosecond, 1, 2, false),
                          EventRow(((std::int64_t{1} << 31) + 5) * kMicrosecond, 7, 8, true)));
  ASSERT_THAT(content.frames, SizeIs(1));
  EXPECT_EQ(content.frames[0].exposure, (ExposureInterval{13 * kMicrosecond, 25 * kMicrosecond}));
  EXPECT_EQ(content.frames[0].stamp_ns, 19 * kMicrosecond);
  EXPECT_EQ(content.frames[0].encoding, "mono16");
  EXPECT_EQ(content.frames[0].size, (SensorSize{3, 2}));
  ASSERT_THAT(content.pixels, SizeIs(12));
  EXPECT_EQ(content.pixels[2], 64);
  ASSERT_THAT(content.samples, SizeIs(1));
  EXPECT_NEAR(content.samples[0].acceleration[1], -9.80665, 1e-6);
  EXPECT_NEAR(content.samples[0].angular_velocity[0], 3.14159, 1e-5);
  EXPECT_THAT(content.damage, SizeIs(0));
}

TEST_F(Aedat3, CutAnywhereGivesWhatIsThere) {
  const std::string whole = wholeRecording();
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const std::string path = write(whole.substr(0, size));
    try {
      const Content content = readAll(path);
      EXPECT_LE(content.events.size(), 3u);
    } catch (const RecordingError& error) {
      EXPECT_LT(size, kHeader.size());
      EXPECT_THAT(error.what(), HasSubstr(path));
    }
  }
}

TEST_F(Aedat3, AnyByteMayBeDamaged) {
  const std::string whole = wholeRecording();
  for (std::size_t at = kHeader.size(); at < whole.size(); ++at) {
    for (const int flip : {0x01, 0x80}) {
      std::string damaged = whole;
      damaged[at] = static_cast<char>(damaged[at] ^ flip);
      const Content content = readAll(write(damaged));
      EXPECT_LE(content.events.size(), damaged.size() / 8) << at;
    }
  }
}

TEST_F(Aedat3, NamesWhatItDoesNotRead) {
  const auto first_damage = [this](const std::string& packets) {
    const Content content = readAll(write(kHeader + packets));
    return content.damage.empty() ? std::string("none") : content.damage[0].what;
  };
  EXPECT_THAT(first_damage(packet(1, 0, 0, 5, "")), HasSubstr("kind 1 with 5 events of 0 bytes"));
  EXPECT_THAT(first_damage(packet(1, INT32_MAX, 0, INT32_MAX, "")), HasSubstr("0 are there"));
  EXPECT_THAT(first_damage(packet(1, 8, 0, -1, "")), HasSubstr("-1 events"));
  EXPECT_THAT(first_damage(packet(1, 8, 0, 1, event(346, 0, true, 1))),
              HasSubstr("an event at 346, 0, expected one within 346x260"));
  EXPECT_THAT(first_damage(packet(1, 8, INT32_MAX, 1, event(1, 2, true, INT32_MAX))),
              HasSubstr("an event at 1, 2, expected one within 346x260 and a time from 0"));
  EXPECT_THAT(first_damage(packet(2, 48, 0, 1, frame(3, 2, 25, 13))),
              HasSubstr("whose exposure ends after its start"));
  EXPECT_THAT(first_damage(packet(2, 40, 0, 1, frame(3, 2, 13, 25).substr(0, 40))),
              HasSubstr("a frame of 3x2"));
  try {
    readAll(write("#!AER-DAT3.1\r\n#Source 1: DVS128\r\n#!END-HEADER\r\n"));
    FAIL() << "a DVS128 has no frames";
  } catch (const RecordingError& error) {
    EXPECT_THAT(error.what(), HasSubstr("recorded by \"DVS128\", expected a DAVIS240 or DAVIS346"));
  }
}

}  // namespace
}  // namespace fast_edi
