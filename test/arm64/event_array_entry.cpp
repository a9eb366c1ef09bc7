/// The fuzzer's entry for the corpus of event arrays, without ROS: messages are read here, as
/// std_msgs/Header and dvs_msgs/EventArray lie on the wire.
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "fast_edi/base/sensor_size.hpp"
#include "fuzz/event_intake.hpp"

namespace {

using fast_edi::fuzzing::DecodedArray;
using fast_edi::fuzzing::InputBytes;

constexpr std::size_t kSizeAndCountBytes = 3 * sizeof(std::uint32_t);

std::optional<DecodedArray> decode(std::vector<std::uint8_t>& message) {
  InputBytes input(message.data(), message.size());
  const auto sequence = input.number<std::uint32_t>();
  input.number<std::uint64_t>();  // stamp
  const auto name_bytes = input.number<std::uint32_t>();
  if (!name_bytes || input.bytes(*name_bytes).size() != *name_bytes) {
    return std::nullopt;
  }
  const auto height = input.number<std::uint32_t>();
  const auto width = input.number<std::uint32_t>();
  const auto count = input.number<std::uint32_t>();
  const std::size_t before = sizeof(*sequence) + sizeof(std::uint64_t) + sizeof(*name_bytes) +
                             std::size_t{name_bytes.value_or(0)} + kSizeAndCountBytes;
  if (!count || *count > (message.size() - before) / fast_edi::kWireEventBytes) {
    return std::nullopt;
  }
  constexpr std::uint32_t kMaxSide = fast_edi::kMaxSide_px;
  fast_edi::SensorSize size;
  if (*width <= kMaxSide && *height <= kMaxSide) {
    size = {static_cast<int>(*width), static_cast<int>(*height)};
  }
  return DecodedArray{{message.data() + before, *count}, size, *sequence};
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fast_edi::fuzzing::runEventArrays({data, size}, decode);
  return 0;
}
