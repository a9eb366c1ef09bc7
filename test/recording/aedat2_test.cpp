/// Files made here, as jAER writes them. A real one is read when FAST_EDI_RECORDINGS is set.
#include <gmock/gmock.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iostream>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include "fast_edi/recording/aedat2_reader.hpp"
#include "fast_edi/recording/open_recording.hpp"
#include "fast_edi/recording/recording_error.hpp"
#include "recording/davis_geometry.hpp"
#include "recording/recording_content.hpp"
#include "support/temporary_directory.hpp"

namespace fast_edi {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;

constexpr SensorSize kSize{240, 180};
constexpr std::int64_t kMicrosecond = kNanosecondsPerMicrosecond;
const std::string kHeader =
    "#!AER-DAT2.0\r\n# This is a raw AE data file\r\n"
    "# AEChip: eu.seebetter.ini.chips.davis.DAVIS240C\r\n#End Of ASCII Header\r\n";

using EventRow = std::tuple<std::int64_t, int, int, bool>;
using Content = testing::RecordingContent;

Content readAll(const std::string& path) {
  const std::unique_ptr<Recording> reader = openAedat2(path);
  return testing::readAll(*reader);
}

/// Writes records with a bit layout of its own.
class Aedat2 : public ::testing::Test {
 protected:
  void put(std::uint32_t address, std::uint32_t t_us) {
    for (const std::uint32_t word : {address, t_us}) {
      for (int shift = 24; shift >= 0; shift -= 8) {
        bytes_ += static_cast<char>(word >> shift & 0xff);
      }
    }
  }
  /// \param x, y from the top left
  void event(int x, int y, bool on, std::uint32_t t_us) {
    put(static_cast<std::uint32_t>(kSize.height - 1 - y) << 22 |
            static_cast<std::uint32_t>(kSize.width - 1 - x) << 12 | (on ? 1U << 11 : 0),
        t_us);
  }
  void read(int x, int y, bool signal, std::uint32_t sample, std::uint32_t t_us) {
    put(1U << 31 | static_cast<std::uint32_t>(kSize.height - 1 - y) << 22 |
            static_cast<std::uint32_t>(x) << 12 | (signal ? 1U << 10 : 0) | sample,
        t_us);
  }
  void imu(std::uint32_t code, std::int16_t number, std::uint32_t t_us) {
    put(1U << 31 | code << 28 |
            static_cast<std::uint32_t>(static_cast<std::uint16_t>(number)) << 12 | 3U << 10,
        t_us);
  }
  static int levelAt(int x, int y) { return (3 * x + 5 * y) % 700; }
  /// All reads of one kind, in columns.
  void readAllPixels(bool signal, std::uint32_t t_us) {
    for (int x = 0; x < kSize.width; ++x) {
      for (int y = 0; y < kSize.height; ++y) {
        const int sample = signal ? 900 - levelAt(x, y) : 900;
        read(x, y, signal, static_cast<std::uint32_t>(sample),
             t_us + static_cast<std::uint32_t>(x));
      }
    }
  }
  std::string write(const std::string& header = kHeader) const {
    const std::string path = directory_.file("recording.aedat");
    std::ofstream(path, std::ios::binary) << header << bytes_;
    return path;
  }
  std::string refusal(const std::string& header) const {
    try {
      readAll(write(header));
    } catch (const RecordingError& error) {
      return error.what();
    }
    return "read";
  }

  const TemporaryDirectory directory_;
  std::string bytes_;
};

TEST_F(Aedat2, EventsAreCountedFromTheTopLeft) {
  event(0, 0, true, 10);
  event(239, 179, false, 11);
  put(1U << 10, 12);  // a signal on the connector
  event(7, 170, true, 13);
  const std::string path = write();
  EXPECT_EQ(formatOf(path), RecordingFormat::kAedat2);
  const Content content = readAll(path);
  EXPECT_THAT(content.events, ElementsAre(EventRow(10 * kMicrosecond, 0, 0, true),
                                          EventRow(11 * kMicrosecond, 239, 179, false),
                                          EventRow(13 * kMicrosecond, 7, 170, true)));
  EXPECT_THAT(content.damage, SizeIs(0));
}

TEST_F(Aedat2, FramesAreResetMinusSignal) {
  readAllPixels(false, 1000);  // the last reset read at 1239
  event(1, 2, true, 5000);
  readAllPixels(true, 9000);
  const Content content = readAll(write());
  EXPECT_THAT(content.events, SizeIs(1));
  EXPECT_THAT(content.damage, SizeIs(0));
  ASSERT_THAT(content.frames, SizeIs(1));
  EXPECT_EQ(content.frames[0].exposure,
            (ExposureInterval{1239 * kMicrosecond, 9000 * kMicrosecond}));
  EXPECT_EQ(content.frames[0].size, kSize);
  EXPECT_EQ(content.frames[0].encoding, "mono16");
  std::vector<std::uint16_t> pixels(kSize.pixelCount());
  ASSERT_EQ(content.pixels.size(), 2 * pixels.size());
  std::memcpy(pixels.data(), content.pixels.data(), content.pixels.size());
  for (int y = 0; y < kSize.height; ++y) {
    for (int x = 0; x < kSize.width; ++x) {
      ASSERT_EQ(pixels[static_cast<std::size_t>(y * kSize.width + x)], levelAt(x, y) << 6);
    }
  }
}

TEST_F(Aedat2, ExposureOfARollingShutterIsThatOfItsFirstColumn) {
  for (int x = 0; x < kSize.width + 10; ++x) {
    for (int y = 0; y < kSize.height; ++y) {
      const auto t_us = static_cast<std::uint32_t>(1000 + 10 * x);
      if (x < kSize.width) {
        read(x, y, false, 900, t_us);
      }
      if (x >= 10) {
        read(x - 10, y, true, 800, t_us);
      }
    }
  }
  const Content content = readAll(write());
  ASSERT_THAT(content.frames, SizeIs(1));
  EXPECT_EQ(content.frames[0].exposure,
            (ExposureInterval{1000 * kMicrosecond, 1100 * kMicrosecond}));
}

TEST_F(Aedat2, AFrameThatIsCutIsNoted) {
  readAllPixels(false, 1000);
  readAllPixels(false, 20'000);
  readAllPixels(true, 30'000);
  readAllPixels(false, 40'000);
  const Content content = readAll(write());
  ASSERT_THAT(content.frames, SizeIs(1));
  EXPECT_EQ(content.frames[0].exposure,
            (ExposureInterval{20'239 * kMicrosecond, 30'000 * kMicrosecond}));
  ASSERT_THAT(content.damage, SizeIs(2));
  EXPECT_THAT(content.damage[0].what, HasSubstr("a frame ends here before"));
  EXPECT_THAT(content.damage[1].what, HasSubstr("the recording ends within a frame"));
}

TEST_F(Aedat2, ImuSamplesHaveSevenNumbers) {
  imu(6, 1, 90);  // the rest of one
  for (std::uint32_t code = 0; code < 7; ++code) {
    imu(code, static_cast<std::int16_t>(code == 1 ? -4096 : 655), 100);
  }
  const Content content = readAll(write());
  ASSERT_THAT(content.samples, SizeIs(1));
  EXPECT_EQ(content.samples[0].t_ns, 100 * kMicrosecond);
  EXPECT_NEAR(content.samples[0].acceleration[1], -9.80665, 1e-9);
  EXPECT_NEAR(content.samples[0].angular_velocity[2], 0.17453, 1e-5);  // 10 deg/s
}

TEST_F(Aedat2, TimesGoOnWhereTheyStartAnew) {
  event(1, 1, true, 0x7fffffff);
  event(1, 1, true, 0x80000000);
  event(1, 1, true, 0xffffffff);
  event(1, 1, true, 5);
  const Content content = readAll(write());
  ASSERT_THAT(content.events, SizeIs(4));
  EXPECT_EQ(std::get<0>(content.events[3]), (0x100000000 + 5) * kMicrosecond);
}

TEST_F(Aedat2, CutAnywhereGivesWhatIsThere) {
  for (int i = 0; i < 4; ++i) {
    event(i, i, true, static_cast<std::uint32_t>(i));
  }
  const std::string whole = kHeader + bytes_;
  const std::string path = directory_.file("cut.aedat");
  for (std::size_t size = kHeader.size(); size < whole.size(); ++size) {
    std::ofstream(path, std::ios::binary) << whole.substr(0, size);
    const Content content = readAll(path);
    EXPECT_THAT(content.events, SizeIs((size - kHeader.size()) / 8));
    EXPECT_EQ(content.damage.empty(), (size - kHeader.size()) % 8 == 0);
  }
  for (std::size_t size = 0; size < kHeader.size(); ++size) {
    std::ofstream(path, std::ios::binary) << whole.substr(0, size);
    try {
      readAll(path);
    } catch (const RecordingError& error) {
      EXPECT_THAT(error.what(), HasSubstr(path));
    }
  }
}

TEST_F(Aedat2, NamesWhatItDoesNotRead) {
  EXPECT_THAT(refusal("#!AER-DAT2.0\r\n"), HasSubstr("a camera that no line \"# AEChip: ...\""));
  EXPECT_THAT(refusal("#!AER-DAT2.0\r\n# AEChip: x.DVS128\r\n"),
              HasSubstr("recorded by \"x.DVS128\", expected a DAVIS240 or DAVIS346"));
  EXPECT_THAT(refusal("#!AER-DAT2.0"), HasSubstr("a line without an end"));
  event(0, 0, true, 1);
  put(0x1ffU << 22, 2);
  const Content content = readAll(write());
  EXPECT_THAT(content.events, SizeIs(1));
  ASSERT_THAT(content.damage, SizeIs(1));
  EXPECT_THAT(content.damage[0].what, HasSubstr("row 511, expected one within 240x180"));
}

TEST(Aedat2Recording, OfADavis240HasEventsAndImuSamples) {
  const char* recordings = std::getenv("FAST_EDI_RECORDINGS");
  if (recordings == nullptr) {
    std::cout << "FAST_EDI_RECORDINGS is not set: files made by the test alone\n";
    return;
  }
  const Content content = readAll(std::string(recordings) + "/davis240c_boxes.aedat");
  EXPECT_THAT(content.events, SizeIs(162'771));
  EXPECT_THAT(content.frames, SizeIs(0));
  EXPECT_THAT(content.samples, SizeIs(4833));
  EXPECT_THAT(content.damage, SizeIs(0));
  double squares = 0.0;
  for (const double a : content.samples.front().acceleration) {
    squares += a * a;
  }
  EXPECT_NEAR(std::sqrt(squares), 9.8, 0.3) << "the camera lies still";
}

TEST(DavisGeometry, IsToldByTheName) {
  EXPECT_EQ(davisSize("eu.seebetter.ini.chips.davis.Davis346blue"), (SensorSize{346, 260}));
  EXPECT_EQ(davisSize("DAVIS240B"), (SensorSize{240, 180}));
  EXPECT_FALSE(davisSize("DVS128"));
}

}  // namespace
}  // namespace fast_edi
