/// \file
/// Records of MCAP, put together by hand.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "recording/mcap_records.hpp"

namespace fast_edi::testing {

using Bytes = std::vector<std::uint8_t>;

template <typename Number>
void append(Bytes& bytes, Number number) {
  const auto* begin = reinterpret_cast<const std::uint8_t*>(&number);
  bytes.insert(bytes.end(), begin, begin + sizeof(number));
}

inline void appendBytes(Bytes& bytes, const Bytes& more) {
  bytes.insert(bytes.end(), more.begin(), more.end());
}

inline void appendText(Bytes& bytes, const std::string& text) {
  append(bytes, static_cast<std::uint32_t>(text.size()));
  bytes.insert(bytes.end(), text.begin(), text.end());
}

inline Bytes mcapRecord(std::uint8_t kind, const Bytes& content) {
  Bytes bytes = {kind};
  append(bytes, static_cast<std::uint64_t>(content.size()));
  appendBytes(bytes, content);
  return bytes;
}

/// The content of a schema: a type of messages.
inline Bytes mcapSchema(std::uint16_t id, const std::string& type) {
  Bytes bytes;
  append(bytes, id);
  appendText(bytes, type);
  appendText(bytes, "ros2msg");
  appendText(bytes, "");
  return bytes;
}

/// The content of a channel.
inline Bytes mcapChannel(std::uint16_t id, std::uint16_t schema, const std::string& topic) {
  Bytes bytes;
  append(bytes, id);
  append(bytes, schema);
  appendText(bytes, topic);
  appendText(bytes, "cdr");
  append(bytes, std::uint32_t{0});
  return bytes;
}

/// The content of a message without data.
inline Bytes mcapMessage(std::uint16_t channel, std::uint64_t time_ns) {
  Bytes bytes;
  append(bytes, channel);
  append(bytes, std::uint32_t{0});
  append(bytes, time_ns);
  append(bytes, time_ns);
  return bytes;
}

/// The content of a chunk.
/// \param stored its records, compressed as named
inline Bytes mcapChunk(std::uint64_t begin_ns, const std::string& compression,
                       std::uint64_t records_bytes, std::uint32_t checksum, const Bytes& stored) {
  Bytes bytes;
  append(bytes, begin_ns);
  append(bytes, begin_ns);
  append(bytes, records_bytes);
  append(bytes, checksum);
  appendText(bytes, compression);
  append(bytes, static_cast<std::uint64_t>(stored.size()));
  appendBytes(bytes, stored);
  return bytes;
}

}  // namespace fast_edi::testing
