/// \file
/// The elements of AEDAT4's packets: events, frames, IMU samples, triggers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "fast_edi/base/types.hpp"
#include "fast_edi/recording/recording.hpp"
#include "recording/aedat4_frame_decoder.hpp"
#include "recording/flatbuffer.hpp"
#include "recording/record_clock.hpp"

namespace fast_edi {

/// Decodes one packet after the other, each item by item.
class Aedat4PacketDecoder {
 public:
  /// Both must outlive this.
  /// \param streams of the recording
  /// \param damage takes notes
  /// \param max_item_events more events of a packet come in several items
  Aedat4PacketDecoder(const std::vector<RecordedStream>& streams,
                      std::vector<RecordingDamage>& damage,
                      std::size_t max_item_events = kMaxItemEvents)
      : streams_(streams), damage_(damage), max_item_events_(max_item_events) {}

  /// Begins a packet.
  /// \param bytes decompressed, which may be cut; must live until next() has returned false
  /// \param stream index of its stream
  /// \param offset of the packet in the file, for notes
  void open(FlatBytes bytes, std::size_t stream, std::uint64_t offset);
  /// The next item of the packet. \return false when there is none left
  bool next(RecordingItem& item) { return giveEvents(item) || giveOther(item); }

 private:
  void note(const std::string& what);
  bool give(RecordingItem& item, std::int64_t t_ns);
  std::int64_t advanceClock(std::int64_t t_ns);
  bool giveEvents(RecordingItem& item);
  bool giveSomeEvents(RecordingItem& item);
  bool giveOther(RecordingItem& item);
  bool giveElement(RecordingItem& item, StreamKind kind, std::size_t index);
  bool giveFrame(RecordingItem& item);
  /// The sensor that frames of \p frames come from: that of its camera's events.
  SensorSize sensorOf(const RecordedStream& frames) const;

  const std::vector<RecordedStream>& streams_;
  std::vector<RecordingDamage>& damage_;
  std::size_t max_item_events_;
  std::size_t stream_ = 0;
  std::uint64_t packet_offset_ = 0;
  std::optional<FlatTable> table_;
  FlatVector elements_;
  std::size_t done_ = 0;  ///< elements that were given
  std::vector<Event> events_;
  Aedat4FrameDecoder frame_decoder_;
  RecordClock clock_;
  std::uint64_t ahead_offset_ = 0;  ///< of the packet whose time the clock does not trust yet
};

}  // namespace fast_edi
