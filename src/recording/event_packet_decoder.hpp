/// \file
/// Packets of events as event_camera_msgs/EventPacket has them
/// (https://github.com/ros-event-camera/event_camera_msgs): bytes in the encoding of the camera or
/// of the driver.
///
/// - `libcaer`: 8 bytes an event, as libcaer has it. The first word: bit 0 valid, bit 1 polarity,
/// bits
///   2..16 y, bits 17..31 x; the second one: the lower 31 bits of the sensor's time [us].
///   `time_base` holds what is above, in the clock of ROS; times may wrap within a packet.
/// - `libcaer_cmp`: 16-bit words with a code in bits 12..15: 0 and 1 the upper and lower 12 bits of
/// the
///   time after `time_base` [us]; 2 x; 3 an event's y, polarity in bit 11; 4 a first y, polarity in
///   bit 11; 5 a mask of 8 events from there on.
/// - `mono`: 64-bit words: bit 63 polarity, bits 48..62 y, bits 32..47 x, bits 0..31 the time after
///   `time_base` [ns].
/// - `evt3`: Prophesee's EVT 3.0
/// (https://docs.prophesee.ai/stable/data/encoding_formats/evt3.html),
///   which has the time of the sensor alone: its first event is put at the stamp of its packet.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fast_edi/base/types.hpp"

namespace fast_edi {

struct EventPacket {
  std::string_view encoding;
  std::uint64_t time_base_ns = 0;
  std::int64_t stamp_ns = 0;
  bool big_endian = false;
  const std::uint8_t* data = nullptr;
  std::size_t size = 0;
};

/// Keeps the state between packets; there is one for each topic.
class EventPacketDecoder {
 public:
  /// Starts with a packet; its data must outlive decoding.
  /// \return what is wrong with it; empty if nothing is
  std::string begin(const EventPacket& packet);
  /// Appends events until there are \p max or some more, or the packet ends.
  /// \return whether the packet has not ended
  bool decode(std::vector<Event>& events, std::size_t max);

  /// Events of this packet that were left out: times before 1970 or after 2106.
  std::size_t untold() const { return untold_; }
  /// Words of this packet with a code that the encoding does not have.
  std::size_t unknownWords() const { return unknown_words_; }

 private:
  enum class Encoding { kLibcaer, kLibcaerCompressed, kMono, kEvt3 };

  void decodeLibcaer(const std::uint8_t* word, std::vector<Event>& events);
  void decodeCompressed(const std::uint8_t* word, std::vector<Event>& events);
  void decodeMono(const std::uint8_t* word, std::vector<Event>& events);
  void decodeEvt3(const std::uint8_t* word, std::vector<Event>& events);
  void setEvt3High(std::uint64_t high);
  void addMask(unsigned mask, unsigned count, bool along_x, std::vector<Event>& events);
  void add(std::uint64_t t_ns, unsigned x, unsigned y, bool on, std::vector<Event>& events);
  std::uint64_t wordTime() const;

  struct LibcaerClock {
    std::uint64_t high_ns = 0;  ///< what is above the lower 31 bits
    std::uint32_t last_low_us = 0;
  };
  /// What earlier words of encodings by 16-bit words have set.
  struct WordState {
    std::uint64_t time_high_us = 0;
    std::uint64_t time_low_us = 0;
    unsigned x = 0;
    unsigned y = 0;
    bool on = false;
    bool has_high = false;
    bool has_time = false;
  };

  EventPacket packet_;
  Encoding encoding_ = Encoding::kLibcaer;
  std::size_t word_bytes_ = 1;
  std::size_t place_ = 0;
  std::size_t untold_ = 0;
  std::size_t unknown_words_ = 0;

  LibcaerClock libcaer_;
  WordState word_;
  std::optional<std::uint64_t> evt3_offset_ns_;  ///< ROS time minus sensor time, modulo 2^64
};

}  // namespace fast_edi
