#include "stream/stream_decoder.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "recording/aedat4_header.hpp"
#include "recording/damage_notes.hpp"
#include "stream/packet_framing.hpp"
#include "stream/stream_error.hpp"

namespace fast_edi {
namespace {

/// Each item becomes a message, and subscribers' queues count messages.
constexpr std::size_t kMaxMessageEvents = 100'000;

}  // namespace

const char* toString(StreamKind kind) {
  switch (kind) {
    case StreamKind::kEvents:
      return "events";
    case StreamKind::kFrames:
      return "frames";
    case StreamKind::kImu:
      return "IMU samples";
    case StreamKind::kTriggers:
      return "triggers";
    case StreamKind::kCalibration:
      break;
  }
  return "calibration";
}

StreamDecoder::StreamDecoder(FlatBytes io_header, StreamKind expected)
    : decoder_(streams_, damage_, kMaxMessageEvents) {
  Aedat4Header header;
  const std::string fault = decodeAedat4Header(io_header, header);
  if (!fault.empty()) {
    throw StreamError(fault);
  }
  std::string served;
  for (const auto& [number, stream] : header.streams) {
    numbers_[number] = streams_.size();
    streams_.push_back(stream);
    served += (served.empty() ? "" : ", ") + std::string(toString(stream.kind));
  }
  const auto main = std::find_if(streams_.begin(), streams_.end(), [expected](const auto& stream) {
    return stream.kind == expected;
  });
  if (main == streams_.end()) {
    std::string faults;
    for (const std::string& description_fault : header.faults) {
      faults += "; " + description_fault;
    }
    throw StreamError("serves " + (served.empty() ? "no stream" : served) + ", expected " +
                      toString(expected) + faults);
  }
  if (expected == StreamKind::kEvents && main->size.pixelCount() == 0) {
    throw StreamError("the header does not say how large the sensor is");
  }
  main_ = static_cast<std::size_t>(main - streams_.begin());
  compression_ = header.compression;
}

void StreamDecoder::open(std::int32_t stream, FlatBytes data) {
  is_open_ = false;
  const std::uint64_t packet = ++packets_;
  const auto number = numbers_.find(stream);
  if (number == numbers_.end()) {
    noteDamage(damage_, {packet, "a packet of stream " + std::to_string(stream) +
                                     ", which the header does not have"});
    return;
  }
  if (number->second != main_) {
    return;  // served beside what the connection is for
  }
  FlatBytes plain = data;
  if (compression_ != Compression::kNone) {
    const std::string fault = decompressor_.run(compression_, data.data, data.size,
                                                PacketFraming::kMaxPacketBytes, plain_);
    if (!fault.empty()) {
      noteDamage(damage_, {packet, fault});
    }
    plain = {plain_.data(), plain_.size()};
  }
  decoder_.open(plain, main_, packet);
  is_open_ = true;
}

bool StreamDecoder::next(RecordingItem& item) {
  return is_open_ && decoder_.next(item);
}

std::vector<RecordingDamage> StreamDecoder::takeDamage() {
  return std::exchange(damage_, {});
}

}  // namespace fast_edi
