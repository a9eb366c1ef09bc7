/// Frames of a rosbag2 that an independent library compressed (test/data/recordings/README.md).
#include "fast_edi/pictures/open_pictures.hpp"

#include <gmock/gmock.h>

#include <memory>
#include <string>

#include "fast_edi/recording/aedat4_reader.hpp"
#include "fast_edi/recording/open_recording.hpp"
#include "recording/recording_content.hpp"

namespace fast_edi {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::readAll;
using testing::RecordingContent;
using ::testing::SizeIs;

const std::string kData = std::string(FAST_EDI_SOURCE_DIR) + "/test/data/recordings/";

TEST(OpenPictures, DecodesCompressedFramesOfRosbag2) {
  Aedat4Reader original(kData + "vendor_none.aedat4");
  const RecordingContent expected = readAll(original);
  const std::unique_ptr<Recording> reader = openRecordingOrPictures(kData + "rosbag2/png");
  for (const RecordedStream& stream : reader->streams()) {
    EXPECT_EQ(stream.camera, "dvs");
    if (stream.kind == StreamKind::kFrames) {
      EXPECT_EQ(stream.name, "frames");
      EXPECT_EQ(stream.size, (SensorSize{48, 40}));
    }
  }
  const RecordingContent content = readAll(*reader);
  EXPECT_THAT(content.damage, IsEmpty());
  EXPECT_EQ(content.events, expected.events);
  ASSERT_THAT(content.frames, SizeIs(expected.frames.size()));
  for (std::size_t i = 0; i < content.frames.size(); ++i) {
    EXPECT_EQ(content.frames[i].stamp_ns, expected.frames[i].stamp_ns);
    EXPECT_EQ(content.frames[i].exposure, expected.frames[i].exposure);
    EXPECT_EQ(content.frames[i].encoding, "mono8");
  }
  EXPECT_EQ(content.pixels, expected.pixels);
}

TEST(OpenPictures, OfFramesThatAreNotDecodedOneNoteTells) {
  const RecordingContent content = readAll(*openRecording(kData + "rosbag2/png"));
  EXPECT_THAT(content.frames, IsEmpty());
  EXPECT_THAT(content.events, SizeIs(2436));
  ASSERT_THAT(content.damage, SizeIs(1));
  EXPECT_THAT(content.damage[0].what,
              HasSubstr("/dvs/image_raw/compressed: frames in PNG or JPEG, which are not decoded"));
}

TEST(OpenPictures, FramesOf16BitsAreDecodedAsSuch) {
  const RecordingContent content = readAll(*openRecordingOrPictures(kData + "rosbag2/room_png"));
  EXPECT_THAT(content.damage, IsEmpty());
  ASSERT_THAT(content.frames, SizeIs(2));
  EXPECT_EQ(content.frames[1].encoding, "mono16");
  EXPECT_THAT(content.samples, SizeIs(::testing::Gt(50u)));
}

}  // namespace
}  // namespace fast_edi
