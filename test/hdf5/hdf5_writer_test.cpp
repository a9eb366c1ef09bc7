#include "fast_edi/hdf5/hdf5_writer.hpp"

#include <gmock/gmock.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "fast_edi/hdf5/hdf5_reader.hpp"
#include "fast_edi/recording/recording_error.hpp"
#include "hdf5/hdf5_dataset.hpp"
#include "recording/recording_content.hpp"
#include "support/temporary_directory.hpp"

namespace fast_edi {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::readAll;
using testing::RecordingContent;
using ::testing::SizeIs;

constexpr SensorSize kSize{24, 16};
constexpr std::int64_t kStart_ns = 1'600'000'000'123'456'000;
const std::vector<RecordedStream> kStreams = {{StreamKind::kEvents, "events", "DAVIS", kSize},
                                              {StreamKind::kFrames, "frames", "DAVIS", kSize}};
constexpr std::size_t kEventStream = 0;
constexpr std::size_t kFrameStream = 1;

std::vector<Event> someEvents(std::size_t count) {
  std::vector<Event> events;
  for (std::size_t i = 0; i < count; ++i) {
    events.push_back({static_cast<std::uint16_t>(i % 24), static_cast<std::uint16_t>(i / 7 % 16),
                      kStart_ns + static_cast<std::int64_t>(i / 3) * 1000, i % 5 < 2});
  }
  return events;
}

class Hdf5WriterTest : public ::testing::TestWithParam<Hdf5Compression> {
 protected:
  static RecordingItem eventItem(const std::vector<Event>& events) {
    RecordingItem item;
    item.stream = kEventStream;
    item.content = RecordedEvents{events.data(), events.size()};
    return item;
  }
  static RecordingItem frameItem(const std::vector<std::uint8_t>& pixels,
                                 const std::string& encoding, std::int64_t stamp_ns) {
    RecordingItem item;
    item.stream = kFrameStream;
    RecordedFrame frame;
    frame.stamp_ns = stamp_ns;
    frame.size = kSize;
    frame.encoding = encoding;
    frame.pixels = pixels.data();
    frame.bytes = pixels.size();
    item.content = frame;
    return item;
  }

  const TemporaryDirectory directory_;
  const std::string path_ = directory_.file("out.h5");
};
INSTANTIATE_TEST_SUITE_P(Compressions, Hdf5WriterTest,
                         ::testing::Values(Hdf5Compression::kNone, Hdf5Compression::kGzip));

TEST_P(Hdf5WriterTest, WritesWhatIsReadAgain) {
  const std::vector<Event> events = someEvents(150'000);  // more than two chunks
  Hdf5Writer writer(path_, kStreams, GetParam(), false);
  writer.write(eventItem(events));
  struct Given {
    const char* encoding;
    std::size_t pixel_bytes;
  };
  const std::vector<Given> frames = {{"mono8", 1}, {"mono16", 2},      {"rgb8", 3},
                                     {"bgr8", 3},  {"bayer_rggb8", 1}, {"bgr16", 6}};
  std::vector<std::uint8_t> pixels;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    pixels.resize(kSize.pixelCount() * frames[i].pixel_bytes);
    for (std::size_t p = 0; p < pixels.size(); ++p) {
      pixels[p] = static_cast<std::uint8_t>(p * 7 + i);
    }
    const std::int64_t stamp_ns = kStart_ns + static_cast<std::int64_t>(i) * 7'001'000;
    RecordingItem item = frameItem(pixels, frames[i].encoding, stamp_ns);
    if (i % 2 == 0) {
      std::get<RecordedFrame>(item.content).exposure =
          ExposureInterval{stamp_ns - 2'000'000, stamp_ns + 2'000'000};
    }
    writer.write(item);
  }
  EXPECT_FALSE(std::filesystem::exists(path_));
  writer.close();
  EXPECT_FALSE(std::filesystem::exists(path_ + ".active"));

  const std::unique_ptr<Recording> reader = openHdf5(path_);
  EXPECT_EQ(reader->streams().at(0).size, kSize);
  const RecordingContent content = readAll(*reader);
  EXPECT_THAT(content.damage, IsEmpty());
  ASSERT_THAT(content.events, SizeIs(events.size()));
  for (std::size_t i = 0; i < events.size(); ++i) {
    const Event& event = events[i];
    ASSERT_EQ(content.events[i], std::make_tuple(event.t_ns, int{event.x}, int{event.y}, event.on));
  }
  ASSERT_THAT(content.frames, SizeIs(frames.size()));
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const std::int64_t stamp_ns = kStart_ns + static_cast<std::int64_t>(i) * 7'001'000;
    EXPECT_EQ(content.frames[i].stamp_ns, stamp_ns);
    EXPECT_EQ(content.frames[i].encoding, frames[i].encoding);
    EXPECT_EQ(content.frames[i].exposure.has_value(), i % 2 == 0);
    if (i % 2 == 0) {
      EXPECT_EQ(*content.frames[i].exposure,
                (ExposureInterval{stamp_ns - 2'000'000, stamp_ns + 2'000'000}));
    }
  }
  EXPECT_EQ(content.pixels, pixels);
}

TEST_F(Hdf5WriterTest, IndexGivesTheFirstEventOfEachMillisecond) {
  Hdf5Writer writer(path_, {kStreams[0]}, Hdf5Compression::kGzip, false);
  const std::int64_t ms_ns = 1'000'000;
  const std::vector<Event> events = {{0, 0, 5 * ms_ns + 300'000, true},
                                     {0, 0, 5 * ms_ns + 900'000, true},
                                     {0, 0, 6 * ms_ns, true},
                                     {0, 0, 8 * ms_ns + 1000, true}};
  writer.write(eventItem(events));
  writer.close();
  const Hdf5File file(path_);
  Hdf5Dataset index(file, "ms_to_idx");
  std::vector<std::uint64_t> values(index.rows());
  ASSERT_EQ(index.read(0, index.rows(), H5T_NATIVE_UINT64, values.data()), "");
  EXPECT_EQ(values, (std::vector<std::uint64_t>{0, 2, 3, 3}));
  Hdf5Dataset offset(file, "t_offset");
  std::int64_t offset_us = 0;
  ASSERT_EQ(offset.read(0, 1, H5T_NATIVE_INT64, &offset_us), "");
  EXPECT_EQ(offset_us, 5000);
}

TEST_F(Hdf5WriterTest, WithoutEventsIsAFile) {
  Hdf5Writer writer(path_, kStreams, Hdf5Compression::kGzip, false);
  const std::vector<std::uint8_t> pixels(kSize.pixelCount());
  writer.write(frameItem(pixels, "mono8", kStart_ns));
  writer.close();
  const RecordingContent content = readAll(*openHdf5(path_));
  EXPECT_THAT(content.events, IsEmpty());
  EXPECT_THAT(content.frames, SizeIs(1));
}

std::string refusal(const std::function<void()>& write) {
  try {
    write();
  } catch (const RecordingError& error) {
    return error.what();
  }
  return "written";
}

TEST_F(Hdf5WriterTest, RefusesWhatItCannotWrite) {
  const auto open = [this](const std::vector<RecordedStream>& streams, bool overwrite) {
    Hdf5Writer(path_, streams, Hdf5Compression::kGzip, overwrite);
  };
  EXPECT_THAT(refusal([&] {
                open({kStreams[0], kStreams[0]}, false);
              }),
              HasSubstr("there are several streams of events, expected one"));
  std::ofstream(path_) << "mine";
  EXPECT_THAT(refusal([&] { open(kStreams, false); }), HasSubstr("exists already"));
  EXPECT_THAT(
      refusal([] { Hdf5Writer("/nonexistent/out.h5", kStreams, Hdf5Compression::kGzip, false); }),
      HasSubstr("cannot write /nonexistent/out.h5.active (HDF5: "));
  Hdf5Writer writer(path_, kStreams, Hdf5Compression::kGzip, true);
  const std::vector<std::uint8_t> pixels(kSize.pixelCount() * 4);
  EXPECT_THAT(refusal([&] { writer.write(frameItem(pixels, "bgra8", kStart_ns)); }),
              HasSubstr("a frame with the encoding bgra8 cannot be written as HDF5"));
}

}  // namespace
}  // namespace fast_edi
