/// \file
/// `dvs_msgs/EventArray` without the `dvs_msgs` package: C++ types of ours that are that message on
/// the wire and in bags.
///
/// roscpp and rosbag compare the md5 alone, so these types also receive `dv_ros_msgs/EventArray`
/// and `prophesee_event_msgs/EventArray`. They publish and record as `dvs_msgs/EventArray`.
///
/// The event records stay the bytes that arrived (see event_wire.hpp); nothing is converted.
///
/// - EventArray owns its records: one block copy out of the receive buffer, which roscpp frees as
///   soon as a message is deserialised.
/// - EventArrayView points into the buffer it was read from: no copy at all. For rosbag alone,
///   where the buffer stays until the next message is read; never subscribe with it.
///
/// Reading trusts no length: an array that claims more records than its message holds throws
/// ros::serialization::StreamOverrunException before anything is allocated.
#pragma once

#include <cstdint>
#include <cstring>
#include <limits>
#include <vector>

#include <ros/message_traits.h>
#include <ros/serialization.h>
#include <std_msgs/Header.h>
#include <boost/shared_ptr.hpp>

#include "fast_edi/base/sensor_size.hpp"
#include "fast_edi/base/types.hpp"
#include "fast_edi/events/event_wire.hpp"
#include "fast_edi/messages/steady_time.hpp"

namespace fast_edi {

/// An event array that owns its records.
class EventArray {
 public:
  using Ptr = boost::shared_ptr<EventArray>;
  using ConstPtr = boost::shared_ptr<const EventArray>;

  std_msgs::Header header;  ///< the stamp means something else in every driver: use the events' own
  std::uint32_t height = 0;  ///< rows of the sensor [px]
  std::uint32_t width = 0;   ///< columns of the sensor [px]

  /// Valid until this object is changed or destroyed.
  WireEvents events() const { return {records_.data(), records_.size() / kWireEventBytes}; }
  /// \pre 0 <= event.t_ns < 2^32 s
  void append(const Event& event) { encodeWireEvent(event, records_); }
  /// \pre as above, for each of \p count events
  void append(const Event* events, std::size_t count) { encodeWireEvents(events, count, records_); }
  void assign(const WireEvents& events) {
    records_.assign(events.data, events.data + events.count * kWireEventBytes);
  }
  /// When reading off the wire began, on the clock of steadyNow(); 0 if it never was on the wire.
  std::int64_t decodingSince() const { return decoding_since_ns_; }
  void noteDecoding() { decoding_since_ns_ = steadyNow(); }
  void reserve(std::size_t events) { records_.reserve(events * kWireEventBytes); }
  void clear() { records_.clear(); }

 private:
  std::vector<std::uint8_t> records_;  ///< whole records only
  std::int64_t decoding_since_ns_ = 0;
};

/// An event array that owns nothing: valid as long as the buffer it was read from.
class EventArrayView {
 public:
  std_msgs::Header header;
  std::uint32_t height = 0;
  std::uint32_t width = 0;

  WireEvents events() const { return events_; }
  void assign(const WireEvents& events) { events_ = events; }
  void noteDecoding() {}

 private:
  WireEvents events_;
};

/// Sensor size as the array states it; {0, 0} when it is no size that a sensor can have (above
/// 32767 px), which the pipeline refuses.
template <typename Array>
SensorSize sensorSize(const Array& array) {
  constexpr std::uint32_t kMaxSide = kMaxSide_px;
  if (array.width > kMaxSide || array.height > kMaxSide) {
    return {};
  }
  return {static_cast<int>(array.width), static_cast<int>(array.height)};
}

/// Bytes of an array's message in front of its records.
template <typename Array>
std::uint32_t fieldsLength(const Array& array) {
  return ros::serialization::serializationLength(array.header) + 3 * sizeof(std::uint32_t);
}

/// Writes these bytes: \p count records follow.
template <typename Array, typename Stream>
void writeFields(const Array& array, std::size_t count, Stream& stream) {
  stream.next(array.header);
  stream.next(array.height);
  stream.next(array.width);
  stream.next(static_cast<std::uint32_t>(count));
}

namespace event_array_detail {

/// What identifies the message, shared by both C++ types.
constexpr char kMd5Sum[] = "5e8beee5a6c107e504c2e78903c224b8";
constexpr char kDataType[] = "dvs_msgs/EventArray";
constexpr char kDefinition[] =
    "Header header\n"
    "uint32 height\n"
    "uint32 width\n"
    "Event[] events\n"
    "\n"
    "================================================================================\n"
    "MSG: std_msgs/Header\n"
    "uint32 seq\n"
    "time stamp\n"
    "string frame_id\n"
    "\n"
    "================================================================================\n"
    "MSG: dvs_msgs/Event\n"
    "uint16 x\n"
    "uint16 y\n"
    "time ts\n"
    "bool polarity\n";

template <typename Array>
struct Md5Trait {
  static const char* value() { return kMd5Sum; }
  static const char* value(const Array&) { return kMd5Sum; }
};

template <typename Array>
struct DataTypeTrait {
  static const char* value() { return kDataType; }
  static const char* value(const Array&) { return kDataType; }
};

template <typename Array>
struct DefinitionTrait {
  static const char* value() { return kDefinition; }
  static const char* value(const Array&) { return kDefinition; }
};

template <typename Array>
struct ArraySerialiser {
  template <typename Stream>
  static void write(Stream& stream, const Array& array) {
    const WireEvents events = array.events();
    writeFields(array, events.count, stream);
    if (!events.empty()) {
      const std::size_t bytes = events.count * kWireEventBytes;
      std::memcpy(stream.advance(static_cast<std::uint32_t>(bytes)), events.data, bytes);
    }
  }

  template <typename Stream>
  static void read(Stream& stream, Array& array) {
    array.noteDecoding();
    stream.next(array.header);
    stream.next(array.height);
    stream.next(array.width);
    std::uint32_t count = 0;
    stream.next(count);
    // In 64 bits: count * 13 may exceed the 32 bits that the stream counts in.
    const std::uint64_t bytes = static_cast<std::uint64_t>(count) * kWireEventBytes;
    if (bytes > stream.getLength()) {
      ros::serialization::throwStreamOverrun();
    }
    array.assign({stream.advance(static_cast<std::uint32_t>(bytes)), count});
  }

  /// \throws ros::serialization::StreamOverrunException for an array beyond a message's 4 GiB
  static std::uint32_t serializedLength(const Array& array) {
    const std::uint64_t length =
        fieldsLength(array) + array.events().count * std::uint64_t{kWireEventBytes};
    if (length > std::numeric_limits<std::uint32_t>::max()) {
      ros::serialization::throwStreamOverrun();
    }
    return static_cast<std::uint32_t>(length);
  }
};

}  // namespace event_array_detail
}  // namespace fast_edi

namespace ros {
namespace message_traits {

template <>
struct IsMessage<fast_edi::EventArray> : TrueType {};
template <>
struct IsMessage<const fast_edi::EventArray> : TrueType {};
template <>
struct HasHeader<fast_edi::EventArray> : TrueType {};
template <>
struct HasHeader<const fast_edi::EventArray> : TrueType {};
template <>
struct MD5Sum<fast_edi::EventArray> : fast_edi::event_array_detail::Md5Trait<fast_edi::EventArray> {
};
template <>
struct DataType<fast_edi::EventArray>
    : fast_edi::event_array_detail::DataTypeTrait<fast_edi::EventArray> {};
template <>
struct Definition<fast_edi::EventArray>
    : fast_edi::event_array_detail::DefinitionTrait<fast_edi::EventArray> {};

template <>
struct IsMessage<fast_edi::EventArrayView> : TrueType {};
template <>
struct IsMessage<const fast_edi::EventArrayView> : TrueType {};
template <>
struct HasHeader<fast_edi::EventArrayView> : TrueType {};
template <>
struct HasHeader<const fast_edi::EventArrayView> : TrueType {};
template <>
struct MD5Sum<fast_edi::EventArrayView>
    : fast_edi::event_array_detail::Md5Trait<fast_edi::EventArrayView> {};
template <>
struct DataType<fast_edi::EventArrayView>
    : fast_edi::event_array_detail::DataTypeTrait<fast_edi::EventArrayView> {};
template <>
struct Definition<fast_edi::EventArrayView>
    : fast_edi::event_array_detail::DefinitionTrait<fast_edi::EventArrayView> {};

}  // namespace message_traits

namespace serialization {

template <>
struct Serializer<fast_edi::EventArray>
    : fast_edi::event_array_detail::ArraySerialiser<fast_edi::EventArray> {};
template <>
struct Serializer<fast_edi::EventArrayView>
    : fast_edi::event_array_detail::ArraySerialiser<fast_edi::EventArrayView> {};

}  // namespace serialization
}  // namespace ros
