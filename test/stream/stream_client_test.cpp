/// Against a server that does what a test says; the vendor's own is in test/peers.
#include "stream/stream_client.hpp"

#include <algorithm>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>

#include "stream/collecting_sink.hpp"
#include "stream/served_stream.hpp"
#include "stream/stream_server.hpp"
#include "support/temporary_directory.hpp"

namespace fast_edi {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;
using testing::CollectingSink;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::ServedStream;
using testing::StreamBytes;
using testing::StreamPeer;
using testing::StreamServer;

constexpr std::int64_t kStart_ns = 1'700'000'000'000'000'000;
constexpr std::int64_t kPacketEvents = 100;

std::vector<Event> someEvents(std::int64_t first) {
  std::vector<Event> events;
  for (std::int64_t i = first; i < first + kPacketEvents; ++i) {
    events.push_back({static_cast<std::uint16_t>(i % 346), static_cast<std::uint16_t>(i % 260),
                      kStart_ns + i * kNanosecondsPerMicrosecond, i % 3 == 0});
  }
  return events;
}

ServedStream eventStream(int packets, Aedat4Compression compression = Aedat4Compression::kNone) {
  StreamBytes bytes({StreamKind::kEvents, "events", "DAVIS346_1", {346, 260}}, compression);
  for (int i = 0; i < packets; ++i) {
    bytes.add(someEvents(i * kPacketEvents));
  }
  return bytes.take();
}

std::vector<std::tuple<std::int64_t, int, int, bool>> expectedEvents(int packets) {
  std::vector<std::tuple<std::int64_t, int, int, bool>> rows;
  for (const Event& event : someEvents(0)) {
    rows.emplace_back(event.t_ns, event.x, event.y, event.on);
  }
  for (int i = 1; i < packets; ++i) {
    for (const Event& event : someEvents(i * kPacketEvents)) {
      rows.emplace_back(event.t_ns, event.x, event.y, event.on);
    }
  }
  return rows;
}

StreamSettings settingsFor(const StreamServer& server, StreamKind kind = StreamKind::kEvents) {
  StreamSettings settings;
  settings.endpoint = server.endpoint();
  settings.kind = kind;
  settings.stall_timeout = milliseconds(20'000);
  return settings;
}

bool hasEvents(const CollectingSink::Content& content, int packets) {
  return content.events.size() >= static_cast<std::size_t>(packets * kPacketEvents);
}

/// Polls a client until \p condition holds, for a minute at most.
template <typename Condition>
bool waitForStatus(const StreamClient& client, Condition condition) {
  for (int i = 0; i < 6000; ++i) {
    if (condition(client.status())) {
      return true;
    }
    std::this_thread::sleep_for(milliseconds(10));
  }
  return false;
}

/// The fault of a client of a server that runs \p script.
std::string faultOf(const StreamServer::Script& script,
                    milliseconds stall_timeout = milliseconds(20'000)) {
  CollectingSink sink;
  const StreamServer server(script);
  StreamSettings settings = settingsFor(server);
  settings.stall_timeout = stall_timeout;
  const StreamClient client(settings, sink);
  EXPECT_TRUE(
      waitForStatus(client, [](const StreamStatus& status) { return !status.fault.empty(); }));
  return client.status().fault;
}

class StreamClientOf : public ::testing::TestWithParam<Aedat4Compression> {};

TEST_P(StreamClientOf, ReceivesEveryEvent) {
  const ServedStream served = eventStream(20, GetParam());
  CollectingSink sink;
  const StreamServer server([&](StreamPeer& peer) {
    peer.send(served.all());
    peer.waitForEnd();
  });
  const StreamClient client(settingsFor(server), sink);
  ASSERT_TRUE(sink.waitFor([](const auto& content) { return hasEvents(content, 20); }));
  EXPECT_EQ(sink.content().events, expectedEvents(20));
  EXPECT_EQ(sink.content().stream.camera, "DAVIS346_1");
  EXPECT_EQ(sink.content().stream.size.width, 346);
  ASSERT_TRUE(waitForStatus(client, [](const auto& status) { return status.packets == 20; }));
  const StreamStatus status = client.status();
  EXPECT_TRUE(status.connected);
  EXPECT_EQ(status.items, 20U * kPacketEvents);
  EXPECT_EQ(status.damaged, 0U);
  EXPECT_EQ(status.cuts, 0U);
}

INSTANTIATE_TEST_SUITE_P(Compressions, StreamClientOf,
                         ::testing::Values(Aedat4Compression::kNone, Aedat4Compression::kLz4,
                                           Aedat4Compression::kZstd));

TEST(StreamClient, ReceivesByteByByte) {
  const ServedStream served = eventStream(2, Aedat4Compression::kLz4);
  CollectingSink sink;
  const StreamServer server([&](StreamPeer& peer) {
    peer.sendInPieces(served.all(), 1);
    peer.waitForEnd();
  });
  const StreamClient client(settingsFor(server), sink);
  ASSERT_TRUE(sink.waitFor([](const auto& content) { return hasEvents(content, 2); }));
  EXPECT_EQ(sink.content().events, expectedEvents(2));
  EXPECT_EQ(client.status().cuts, 0U);
}

TEST(StreamClient, ReceivesOverALocalSocket) {
  const TemporaryDirectory directory;
  const ServedStream served = eventStream(3);
  CollectingSink sink;
  const StreamServer server(
      [&](StreamPeer& peer) {
        peer.send(served.all());
        peer.waitForEnd();
      },
      directory.file("events.sock"));
  const StreamClient client(settingsFor(server), sink);
  ASSERT_TRUE(sink.waitFor([](const auto& content) { return hasEvents(content, 3); }));
  EXPECT_EQ(sink.content().events, expectedEvents(3));
}

TEST(StreamClient, ReceivesFramesSamplesAndTriggers) {
  const std::vector<std::uint8_t> pixels = {1, 2, 3, 4, 5, 6};
  StreamBytes frames({StreamKind::kFrames, "frames", "DAVIS346_1", {3, 2}},
                     Aedat4Compression::kLz4);
  RecordedFrame frame;
  frame.exposure = ExposureInterval{kStart_ns, kStart_ns + kNanosecondsPerMillisecond};
  frame.stamp_ns = kStart_ns;
  frame.size = {3, 2};
  frame.encoding = "mono8";
  frame.pixels = pixels.data();
  frame.bytes = pixels.size();
  frames.add(frame);
  StreamBytes imu({StreamKind::kImu, "imu", "DAVIS346_1", {}}, Aedat4Compression::kNone);
  imu.add(RecordedImu{kStart_ns + 1000, {0.0, 0.0, 9.8}, {}});
  imu.add(RecordedImu{kStart_ns + 2000, {0.0, 0.0, 9.8}, {}});
  StreamBytes triggers({StreamKind::kTriggers, "triggers", "DAVIS346_1", {}},
                       Aedat4Compression::kZstd);
  triggers.add(RecordedTrigger{kStart_ns, 8});
  triggers.add(RecordedTrigger{kStart_ns, 9});
  CollectingSink sink;
  std::vector<std::unique_ptr<StreamServer>> servers;
  std::vector<std::unique_ptr<StreamClient>> clients;
  const auto serve = [&](StreamKind kind, const ServedStream& served) {
    servers.push_back(std::make_unique<StreamServer>([served](StreamPeer& peer) {
      peer.send(served.all());
      peer.waitForEnd();
    }));
    clients.push_back(std::make_unique<StreamClient>(settingsFor(*servers.back(), kind), sink));
  };
  serve(StreamKind::kFrames, frames.take());
  serve(StreamKind::kImu, imu.take());
  serve(StreamKind::kTriggers, triggers.take());
  ASSERT_TRUE(sink.waitFor([](const auto& content) {
    return content.frames.size() == 1 && content.samples.size() == 2 &&
           content.triggers.size() == 2;
  }));
  const CollectingSink::Content content = sink.content();
  EXPECT_EQ(content.frames[0].start_ns, kStart_ns);
  EXPECT_EQ(content.frames[0].end_ns, kStart_ns + kNanosecondsPerMillisecond);
  EXPECT_EQ(content.pixels, pixels);
  EXPECT_THAT(content.samples, ElementsAre(kStart_ns + 1000, kStart_ns + 2000));
  EXPECT_THAT(content.triggers, ElementsAre(8, 9));
}

TEST(StreamClient, ConnectsAgainAfterEachCut) {
  constexpr int kCuts = 10;
  const ServedStream served = eventStream(2);
  CollectingSink sink;
  std::vector<steady_clock::duration> gaps;  // of the server's thread until there are ten
  steady_clock::time_point cut;
  const StreamServer server([&](StreamPeer& peer) {
    if (peer.number() > 0) {
      gaps.push_back(steady_clock::now() - cut);
    }
    // The first packet, and of the second one byte more each time, from none on.
    peer.send(served.header + served.packets[0] +
              served.packets[1].substr(0, static_cast<std::size_t>(peer.number())));
    if (peer.number() == kCuts) {
      peer.waitForEnd();
    }
    cut = steady_clock::now();
  });
  const StreamClient client(settingsFor(server), sink);
  ASSERT_TRUE(sink.waitFor([](const auto& content) { return hasEvents(content, kCuts + 1); }));
  ASSERT_EQ(gaps.size(), static_cast<std::size_t>(kCuts));
  std::nth_element(gaps.begin(), gaps.begin() + kCuts / 2, gaps.end());
  EXPECT_LT(gaps[kCuts / 2], std::chrono::seconds(1));
  const StreamStatus status = client.status();
  EXPECT_EQ(status.connections, kCuts + 1U);
  EXPECT_EQ(status.cuts, static_cast<std::uint64_t>(kCuts));
  EXPECT_EQ(status.stalls, 0U);
  EXPECT_EQ(sink.content().begun, kCuts + 1);
  EXPECT_THAT(status.cut, HasSubstr("in the middle of a packet"));
}

TEST(StreamClient, WaitsForAServerThatIsNotThereYet) {
  const TemporaryDirectory directory;
  const ServedStream served = eventStream(1);
  CollectingSink sink;
  StreamSettings settings;
  settings.endpoint.socket_path = directory.file("later.sock");
  const StreamClient client(settings, sink);
  ASSERT_TRUE(waitForStatus(client, [](const auto& status) { return status.attempts > 2; }));
  EXPECT_THAT(client.status().fault, HasSubstr("cannot connect: No such file"));
  EXPECT_EQ(client.status().cuts, 0U) << "there was no connection to be cut";
  const StreamServer server(
      [&](StreamPeer& peer) {
        peer.send(served.all());
        peer.waitForEnd();
      },
      settings.endpoint.socket_path);
  EXPECT_TRUE(sink.waitFor([](const auto& content) { return hasEvents(content, 1); }));
}

TEST(StreamClient, EndsAConnectionThatStalls) {
  const ServedStream served = eventStream(2);
  for (const std::size_t cut : {std::size_t{0}, std::size_t{3}, served.packets[1].size() - 1}) {
    CollectingSink sink;
    const StreamServer server([&](StreamPeer& peer) {
      peer.send(served.header + served.packets[0] + served.packets[1].substr(0, cut));
      peer.waitForEnd();
    });
    StreamSettings settings = settingsFor(server);
    settings.stall_timeout = milliseconds(100);
    const StreamClient client(settings, sink);
    ASSERT_TRUE(waitForStatus(client, [](const auto& status) { return status.stalls >= 2; }));
    EXPECT_THAT(client.status().cut, HasSubstr("nothing came for 0.1 s"));
    EXPECT_GE(server.connections(), 2);
  }
}

TEST(StreamClient, TriggersMayBeSilent) {
  StreamBytes bytes({StreamKind::kTriggers, "triggers", "DAVIS346_1", {}},
                    Aedat4Compression::kNone);
  bytes.add(RecordedTrigger{kStart_ns, 2});
  bytes.add(RecordedTrigger{kStart_ns + 1000, 3});
  const ServedStream served = bytes.take();
  CollectingSink sink;
  const StreamServer server([&](StreamPeer& peer) {
    peer.send(served.header + served.packets[0]);
    peer.pause(milliseconds(300));
    peer.send(served.packets[1]);
    peer.waitForEnd();
  });
  StreamSettings settings = settingsFor(server, StreamKind::kTriggers);
  settings.stall_timeout = milliseconds(50);
  const StreamClient client(settings, sink);
  ASSERT_TRUE(sink.waitFor([](const auto& content) { return content.triggers.size() == 2; }));
  EXPECT_EQ(client.status().cuts, 0U);
}

TEST(StreamClient, NamesWhatIsNoStream) {
  EXPECT_THAT(faultOf([](StreamPeer& peer) { peer.send("HTTP/1.1 400 Bad Request\r\n\r\n"); }),
              HasSubstr("expected the header of a stream of DV, got the answer of a web server"));
  EXPECT_THAT(faultOf([](StreamPeer& peer) { peer.send("#!AER-DAT4.0\r\n and more"); }),
              HasSubstr("got an AEDAT file"));
  EXPECT_THAT(faultOf([](StreamPeer&) {}), HasSubstr("before its header was complete"));
  EXPECT_THAT(faultOf([](StreamPeer& peer) { peer.send(std::string(64, '\xab')); }),
              HasSubstr("got the bytes ab ab"));
}

TEST(StreamClient, NamesAServerThatWantsTls) {
  // Says nothing until the client does, then complains that this was no greeting.
  const std::string fault = faultOf(
      [](StreamPeer& peer) {
        if (!peer.receive().empty()) {
          peer.send(std::string("\x15\x03\x03\x00\x02\x02\x0a", 7));
        }
        peer.waitForEnd();
      },
      milliseconds(100));
  EXPECT_THAT(fault, HasSubstr("TLS: encrypted streams are not supported"));
  EXPECT_THAT(faultOf([](StreamPeer& peer) { peer.waitForEnd(); }, milliseconds(100)),
              HasSubstr("nothing came for 0.1 s, expected a header"));
}

TEST(StreamClient, RefusesAnotherKindOfStream) {
  const ServedStream served = eventStream(1);
  CollectingSink sink;
  const StreamServer server([&](StreamPeer& peer) {
    peer.send(served.all());
    peer.waitForEnd();
  });
  const StreamClient client(settingsFor(server, StreamKind::kFrames), sink);
  ASSERT_TRUE(waitForStatus(client, [](const auto& status) { return !status.fault.empty(); }));
  EXPECT_EQ(client.status().fault, "serves events, expected frames");
  EXPECT_EQ(sink.content().begun, 0);
}

TEST(StreamClient, RefusesHostileLengths) {
  const ServedStream served = eventStream(1);
  const auto after_header = [&](const std::string& head) {
    return faultOf([&](StreamPeer& peer) {
      peer.send(served.header + head);
      peer.waitForEnd();
    });
  };
  EXPECT_THAT(after_header(std::string("\0\0\0\0\xff\xff\xff\x7f", 8)),
              HasSubstr("a packet of stream 0 with 2147483647 bytes, expected 1.."));
  EXPECT_THAT(after_header(std::string("\0\0\0\0\xff\xff\xff\xff", 8)), HasSubstr("with -1 bytes"));
  EXPECT_THAT(after_header(std::string(8, '\0')), HasSubstr("with 0 bytes"));
}

TEST(StreamClient, GoesOnBehindADamagedPacket) {
  const ServedStream served = eventStream(3, Aedat4Compression::kLz4);
  std::string damaged = served.packets[1];
  damaged[20] = static_cast<char>(damaged[20] ^ 0x55);
  std::string foreign = served.packets[1];
  foreign[0] = 7;  // of a stream that the header does not have
  CollectingSink sink;
  const StreamServer server([&](StreamPeer& peer) {
    peer.send(served.header + served.packets[0] + damaged + foreign + served.packets[2]);
    peer.waitForEnd();
  });
  const StreamClient client(settingsFor(server), sink);
  ASSERT_TRUE(waitForStatus(client, [](const auto& status) { return status.packets == 4; }));
  const StreamStatus status = client.status();
  EXPECT_TRUE(status.connected);
  EXPECT_GE(status.damaged, 2U);
  EXPECT_THAT(status.damage, HasSubstr("packet 3: a packet of stream 7"));
  EXPECT_GE(status.items, 2U * kPacketEvents);
}

/// Fails once, as memory may.
class FailingSink : public CollectingSink {
 public:
  void add(const RecordingItem& item) override {
    if (!failed_) {
      failed_ = true;
      throw std::bad_alloc();
    }
    CollectingSink::add(item);
  }

 private:
  bool failed_ = false;
};

TEST(StreamClient, OutlivesAFailureOfItsSink) {
  const ServedStream served = eventStream(1);
  FailingSink sink;
  const StreamServer server([&](StreamPeer& peer) {
    peer.send(served.all());
    peer.waitForEnd();
  });
  const StreamClient client(settingsFor(server), sink);
  ASSERT_TRUE(sink.waitFor([](const auto& content) { return hasEvents(content, 1); }));
  EXPECT_EQ(client.status().cuts, 1U);
  EXPECT_THAT(client.status().cut, HasSubstr("bad_alloc"));
}

TEST(StreamClient, EndsAtOnceWhateverItWaitsFor) {
  const ServedStream served = eventStream(2);
  const std::vector<std::string> sent = {"", served.header.substr(0, 5), served.header,
                                         served.header + served.packets[0].substr(0, 100)};
  for (const std::string& bytes : sent) {
    CollectingSink sink;
    const StreamServer server([&](StreamPeer& peer) {
      peer.send(bytes);
      peer.waitForEnd();
    });
    auto client = std::make_unique<StreamClient>(settingsFor(server), sink);
    ASSERT_TRUE(waitForStatus(*client, [](const auto& status) { return status.attempts == 1; }));
    const steady_clock::time_point begin = steady_clock::now();
    client.reset();
    EXPECT_LT(steady_clock::now() - begin, std::chrono::seconds(5)) << "of a time-out of 20 s";
  }
}

}  // namespace
}  // namespace fast_edi
