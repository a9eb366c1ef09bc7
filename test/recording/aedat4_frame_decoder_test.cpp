#include "recording/aedat4_frame_decoder.hpp"

#include <gmock/gmock.h>

#include <cstdint>
#include <numeric>
#include <optional>
#include <vector>

#include "recording/aedat4_header.hpp"
#include "recording/flatbuffer_writer.hpp"

namespace fast_edi {
namespace {

using ::testing::HasSubstr;

/// What a frame's table holds; times in microseconds.
struct Stated {
  std::int64_t time = 0;
  std::int64_t exposure_start = 0;
  std::int64_t exposure_end = 0;
  std::uint8_t format = 0;
  std::int16_t width = 3;
  std::int16_t height = 2;
  std::int16_t x = 0;
  std::int16_t y = 0;
  std::size_t pixel_bytes = 6;
  std::int64_t exposure = 0;
};

/// Pixels of 1, 2, 3...
std::vector<std::uint8_t> packetOf(const Stated& stated) {
  FlatBufferWriter buffer(kAedat4Frames);
  std::vector<FlatBufferWriter::Reference> places;
  buffer.setRoot(buffer.table(
      {FlatBufferWriter::number(0, stated.time), FlatBufferWriter::number(3, stated.exposure_start),
       FlatBufferWriter::number(4, stated.exposure_end), FlatBufferWriter::number(5, stated.format),
       FlatBufferWriter::number(6, stated.width), FlatBufferWriter::number(7, stated.height),
       FlatBufferWriter::number(8, stated.x), FlatBufferWriter::number(9, stated.y),
       FlatBufferWriter::reference(10), FlatBufferWriter::number(11, stated.exposure)},
      places));
  std::vector<std::uint8_t> pixels(stated.pixel_bytes);
  std::iota(pixels.begin(), pixels.end(), std::uint8_t{1});
  buffer.vector(places[8], pixels.data(), pixels.size(), 1, 1);
  return buffer.finish();
}

class Aedat4Frame : public ::testing::Test {
 protected:
  /// \return what is wrong
  std::string decode(const Stated& stated, SensorSize sensor = {3, 2}) {
    packet_ = packetOf(stated);
    const std::optional<FlatTable> table =
        FlatTable::root({packet_.data(), packet_.size()}, kAedat4Frames);
    frame_ = {};
    return table ? decoder_.decode(*table, sensor, frame_) : "no frame";
  }
  std::vector<std::uint8_t> pixels() const { return {frame_.pixels, frame_.pixels + frame_.bytes}; }

  std::vector<std::uint8_t> packet_;
  Aedat4FrameDecoder decoder_;
  RecordedFrame frame_;
};

TEST_F(Aedat4Frame, OfThePartOfASensorIsPutWhereItBelongs) {
  Stated stated;
  stated.x = 1;
  stated.y = 1;
  ASSERT_EQ(decode(stated, {4, 4}), "");
  EXPECT_EQ(frame_.size, (SensorSize{4, 4}));
  EXPECT_EQ(pixels(), (std::vector<std::uint8_t>{0, 0, 0, 0, 0, 1, 2, 3, 0, 4, 5, 6, 0, 0, 0, 0}));
}

TEST_F(Aedat4Frame, BeyondTheSensorStaysAsItIs) {
  struct Place {
    std::int16_t x;
    std::int16_t y;
  };
  for (const Place place : {Place{2, 1}, Place{1, 3}, Place{-1, 1}, Place{1, -1},
                            Place{INT16_MAX, INT16_MAX}, Place{INT16_MIN, INT16_MIN}}) {
    Stated stated;
    stated.x = place.x;
    stated.y = place.y;
    ASSERT_EQ(decode(stated, {4, 4}), "");
    EXPECT_EQ(frame_.size, (SensorSize{3, 2}));
    EXPECT_EQ(pixels(), (std::vector<std::uint8_t>{1, 2, 3, 4, 5, 6}));
  }
  ASSERT_EQ(decode({}, {}), "") << "a sensor of unknown size";
  EXPECT_EQ(frame_.size, (SensorSize{3, 2}));
}

TEST_F(Aedat4Frame, HasItsExposureHoweverItIsStated) {
  Stated both;
  both.exposure_start = 1000;
  both.exposure_end = 1200;
  Stated start_and_length;
  start_and_length.exposure_start = 1000;
  start_and_length.exposure = 200;
  Stated time_and_length;
  time_and_length.time = 1000;
  time_and_length.exposure = 200;
  for (const Stated& stated : {both, start_and_length, time_and_length}) {
    ASSERT_EQ(decode(stated), "");
    ASSERT_TRUE(frame_.exposure.has_value());
    EXPECT_EQ(frame_.exposure->start_ns, 1'000'000);
    EXPECT_EQ(frame_.exposure->end_ns, 1'200'000);
    EXPECT_EQ(frame_.stamp_ns, 1'100'000);
  }
  Stated time_alone;
  time_alone.time = 1000;
  ASSERT_EQ(decode(time_alone), "");
  EXPECT_FALSE(frame_.exposure.has_value());
  EXPECT_EQ(frame_.stamp_ns, 1'000'000);
}

TEST_F(Aedat4Frame, IsRefusedWithTheReason) {
  Stated stated;
  stated.pixel_bytes = 5;
  EXPECT_EQ(decode(stated), "of 3 x 2 pixels with 5 bytes, expected 6");
  stated = {};
  stated.width = -3;
  EXPECT_EQ(decode(stated), "of -3 x 2 pixels with 6 bytes, expected 0");
  stated = {};
  stated.format = 1;
  EXPECT_THAT(decode(stated), HasSubstr("of format 1, expected 0, 16, 24"));
  stated = {};
  stated.time = -1;
  EXPECT_EQ(decode(stated), "with a time before 1970 or after 2106");
  EXPECT_EQ(frame_.pixels, nullptr);
}

TEST_F(Aedat4Frame, StatesASizeThatIsNeverNegative) {
  Stated stated;
  stated.width = -3;
  decode(stated);
  const std::optional<FlatTable> table =
      FlatTable::root({packet_.data(), packet_.size()}, kAedat4Frames);
  ASSERT_TRUE(table.has_value());
  EXPECT_EQ(Aedat4FrameDecoder::sizeOf(*table), (SensorSize{0, 2}));
}

}  // namespace
}  // namespace fast_edi
