/// Event arrays from the wire: decoding by both C++ types, then the pipeline's intake. The layout
/// of the input is that of runEventArrays().
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <vector>

#include <ros/serialization.h>

#include "fast_edi/messages/event_array.hpp"
#include "fuzz/event_intake.hpp"
#include "fuzz/fuzzing.hpp"

namespace {

using fast_edi::fuzzing::DecodedArray;
using fast_edi::fuzzing::require;

/// \return false when the message is refused
template <typename Array>
bool decode(std::vector<std::uint8_t>& message, Array& array) {
  try {
    ros::serialization::IStream stream(message.data(), static_cast<std::uint32_t>(message.size()));
    ros::serialization::deserialize(stream, array);
    return true;
  } catch (const ros::serialization::StreamOverrunException&) {
    return false;
  }
}

std::optional<DecodedArray> decodeByBothTypes(std::vector<std::uint8_t>& message) {
  fast_edi::EventArray owner;
  fast_edi::EventArrayView view;
  const bool decoded = decode(message, owner);
  require(decode(message, view) == decoded, "both types of event arrays refuse the same messages");
  if (!decoded) {
    return std::nullopt;
  }
  const fast_edi::WireEvents events = view.events();
  require(events.count == owner.events().count &&
              (events.empty() || std::memcmp(events.data, owner.events().data,
                                             events.count * fast_edi::kWireEventBytes) == 0),
          "both types of event arrays hold the same events");
  return DecodedArray{events, fast_edi::sensorSize(view), view.header.seq};
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fast_edi::fuzzing::runEventArrays({data, size}, decodeByBothTypes);
  return 0;
}
