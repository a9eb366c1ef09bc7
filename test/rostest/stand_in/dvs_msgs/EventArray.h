// Stands in for the header that the dvs_msgs package generates: the same names, layout and traits,
// and a count of how often an array was serialised.
#pragma once

#include <atomic>
#include <cstdint>
#include <vector>

#include <ros/message_traits.h>
#include <ros/serialization.h>
#include <ros/time.h>
#include <std_msgs/Header.h>
#include <boost/shared_ptr.hpp>

namespace dvs_msgs {

struct Event {
  std::uint16_t x = 0;
  std::uint16_t y = 0;
  ros::Time ts;
  std::uint8_t polarity = 0;
};
static_assert(sizeof(Event) == 16, "the layout of generated events");

struct EventArray {
  using Ptr = boost::shared_ptr<EventArray>;
  using ConstPtr = boost::shared_ptr<const EventArray>;

  std_msgs::Header header;
  std::uint32_t height = 0;
  std::uint32_t width = 0;
  std::vector<Event> events;
};

inline std::atomic<int> serialisations{0};

}  // namespace dvs_msgs

namespace ros {
namespace message_traits {

template <>
struct IsMessage<dvs_msgs::EventArray> : TrueType {};
template <>
struct IsMessage<const dvs_msgs::EventArray> : TrueType {};
template <>
struct HasHeader<dvs_msgs::EventArray> : TrueType {};
template <>
struct HasHeader<const dvs_msgs::EventArray> : TrueType {};
template <>
struct MD5Sum<dvs_msgs::EventArray> {
  static const char* value() { return "5e8beee5a6c107e504c2e78903c224b8"; }
  static const char* value(const dvs_msgs::EventArray&) { return value(); }
};
template <>
struct DataType<dvs_msgs::EventArray> {
  static const char* value() { return "dvs_msgs/EventArray"; }
  static const char* value(const dvs_msgs::EventArray&) { return value(); }
};
template <>
struct Definition<dvs_msgs::EventArray> {
  static const char* value() { return "Header header\nuint32 height\nuint32 width\n"; }
  static const char* value(const dvs_msgs::EventArray&) { return value(); }
};

}  // namespace message_traits

namespace serialization {

template <>
struct Serializer<dvs_msgs::Event> {
  template <typename Stream, typename T>
  static void allInOne(Stream& stream, T event) {
    stream.next(event.x);
    stream.next(event.y);
    stream.next(event.ts);
    stream.next(event.polarity);
  }
  ROS_DECLARE_ALLINONE_SERIALIZER
};

template <>
struct Serializer<dvs_msgs::EventArray> {
  template <typename Stream>
  static void write(Stream& stream, const dvs_msgs::EventArray& array) {
    ++dvs_msgs::serialisations;
    stream.next(array.header);
    stream.next(array.height);
    stream.next(array.width);
    stream.next(array.events);
  }
  template <typename Stream>
  static void read(Stream& stream, dvs_msgs::EventArray& array) {
    stream.next(array.header);
    stream.next(array.height);
    stream.next(array.width);
    stream.next(array.events);
  }
  static std::uint32_t serializedLength(const dvs_msgs::EventArray& array) {
    return serializationLength(array.header) + serializationLength(array.height) +
           serializationLength(array.width) + serializationLength(array.events);
  }
};

}  // namespace serialization
}  // namespace ros
