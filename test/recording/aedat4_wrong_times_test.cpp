/// Single wrong times in AEDAT4, far ahead of all others.
#include <gmock/gmock.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include "fast_edi/recording/aedat4_reader.hpp"
#include "fast_edi/recording/aedat4_writer.hpp"
#include "support/temporary_directory.hpp"

namespace fast_edi {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr SensorSize kSize{16, 12};
constexpr std::int64_t kStart_ns = 1'700'000'000'000'000'000;
constexpr std::int64_t kMs = kNanosecondsPerMillisecond;
constexpr std::int64_t kHour_ns = 3600 * kNanosecondsPerSecond;
constexpr int kPackets = 20;
constexpr int kWrong = 7;  ///< packet with a wrong time

enum Stream : std::size_t { kEvents, kFrames, kImu, kTriggers };

std::int64_t startOf(int packet) {
  return kStart_ns + packet * 10 * kMs;
}

class Aedat4WrongTimes : public ::testing::Test {
 protected:
  Aedat4Writer writer() const {
    return {path_,
            {{StreamKind::kEvents, "events", "DAVIS346_1", kSize},
             {StreamKind::kFrames, "frames", "DAVIS346_1", kSize},
             {StreamKind::kImu, "imu", "DAVIS346_1", {}},
             {StreamKind::kTriggers, "triggers", "DAVIS346_1", {}}},
            Aedat4Compression::kLz4,
            true};
  }
  void writeEvents(Aedat4Writer& writer, int packet, std::int64_t last_ahead_ns) const {
    std::vector<Event> events;
    for (int i = 0; i < 10; ++i) {
      events.push_back({1, 2, startOf(packet) + i * kMs, true});
    }
    events.back().t_ns += last_ahead_ns;
    writer.write({kEvents, 0, RecordedEvents{events.data(), events.size()}});
  }
  void writeFrame(Aedat4Writer& writer, std::int64_t start_ns) const {
    RecordedFrame frame;
    frame.exposure = ExposureInterval{start_ns, start_ns + 5 * kMs};
    frame.stamp_ns = frame.exposure->at(ExposureInstant::kMid);
    frame.size = kSize;
    frame.encoding = "mono8";
    frame.pixels = pixels_.data();
    frame.bytes = pixels_.size();
    writer.write({kFrames, 0, frame});
  }
  /// Ten events, a frame, a sample and a trigger in each packet of time; one of them an hour ahead.
  void write(Stream wrong) const {
    Aedat4Writer file = writer();
    for (int packet = 0; packet < kPackets; ++packet) {
      const auto ahead_ns = [&](Stream stream) {
        return packet == kWrong && stream == wrong ? kHour_ns : 0;
      };
      const std::int64_t end_ns = startOf(packet) + 9 * kMs;
      writeEvents(file, packet, ahead_ns(kEvents));
      writeFrame(file, end_ns - 5 * kMs + ahead_ns(kFrames));
      file.write({kImu, 0, RecordedImu{end_ns + ahead_ns(kImu), {}, {}}});
      file.write({kTriggers, 0, RecordedTrigger{end_ns + ahead_ns(kTriggers), 1}});
    }
    file.close();
  }

  const TemporaryDirectory directory_;
  const std::string path_ = directory_.file("recording.aedat4");
  const std::vector<std::uint8_t> pixels_ = std::vector<std::uint8_t>(kSize.pixelCount(), 1);
};

TEST_F(Aedat4WrongTimes, CostTheirOwnRecordAlone) {
  for (const Stream wrong : {kEvents, kFrames, kImu, kTriggers}) {
    SCOPED_TRACE(wrong);
    write(wrong);
    Aedat4Reader reader(path_);
    RecordingItem item;
    std::vector<int> items(4);
    std::int64_t before_ns = 0;
    while (reader.next(item)) {
      const int packet = items[item.stream]++;
      EXPECT_GE(item.record_ns, before_ns);
      before_ns = item.record_ns;
      EXPECT_GE(item.record_ns, startOf(packet)) << item.stream;
      EXPECT_LT(item.record_ns, startOf(kPackets)) << item.stream;
      if (item.stream == kEvents) {
        EXPECT_LT(item.record_ns, startOf(packet + 1)) << packet;
      }
    }
    EXPECT_EQ(items, std::vector<int>(4, kPackets));
    ASSERT_THAT(reader.damage(), SizeIs(1));
    EXPECT_THAT(reader.damage()[0].what,
                HasSubstr("a time 3600.0 s ahead of those around it: it does not count"));
    EXPECT_GT(reader.damage()[0].offset, 0U);
  }
}

TEST_F(Aedat4WrongTimes, APauseIsNone) {
  {
    Aedat4Writer file = writer();
    for (int packet = 0; packet < kPackets; ++packet) {
      writeEvents(file, packet, 0);
    }
    file.write({kImu, 0, RecordedImu{startOf(kPackets) + kHour_ns, {}, {}}});
    file.write({kImu, 0, RecordedImu{startOf(kPackets) + kHour_ns + kMs, {}, {}}});
    file.close();
  }
  Aedat4Reader reader(path_);
  RecordingItem item;
  while (reader.next(item)) {
  }
  EXPECT_EQ(item.record_ns, startOf(kPackets) + kHour_ns + kMs);
  EXPECT_THAT(reader.damage(), IsEmpty());
}

/// As scripts write: all events first, then all frames, which the file's table puts in order.
TEST_F(Aedat4WrongTimes, DoNotMoveThePacketsBehind) {
  for (const auto& [wrong, wrong_packet] :
       {std::pair(kEvents, kWrong), {kFrames, kWrong}, {kFrames, 0}, {kEvents, kPackets - 1}}) {
    SCOPED_TRACE(std::to_string(wrong) + " " + std::to_string(wrong_packet));
    {
      Aedat4Writer file = writer();
      for (int packet = 0; packet < kPackets; ++packet) {
        writeEvents(file, packet, packet == wrong_packet && wrong == kEvents ? kHour_ns : 0);
      }
      for (int packet = 0; packet < kPackets; ++packet) {
        writeFrame(file, startOf(packet) + 4 * kMs +
                             (packet == wrong_packet && wrong == kFrames ? kHour_ns : 0));
      }
      file.close();
    }
    Aedat4Reader reader(path_);
    RecordingItem item;
    std::vector<std::size_t> order;
    while (reader.next(item)) {
      order.push_back(item.stream);
    }
    ASSERT_THAT(order, SizeIs(2 * kPackets));
    int lead = 0;
    for (const std::size_t stream : order) {
      lead += stream == kEvents ? 1 : -1;
      EXPECT_LE(std::abs(lead), 2) << "events and frames do not come together";
    }
  }
}

}  // namespace
}  // namespace fast_edi
