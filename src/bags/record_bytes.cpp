#include "bags/record_bytes.hpp"

namespace fast_edi {
namespace {

/// As it lies in memory, which is little-endian on all systems that ROS 1 runs on.
template <typename Number>
std::string_view bytesOf(const Number& number) {
  return {reinterpret_cast<const char*>(&number), sizeof(number)};
}

}  // namespace

HeaderBytes::HeaderBytes(RecordKind kind) {
  add("op", bytesOf(kind));
}

HeaderBytes& HeaderBytes::add(std::string_view name, std::string_view value) {
  appendNumber(bytes_, static_cast<std::uint32_t>(name.size() + 1 + value.size()));
  bytes_.append(name).append(1, '=').append(value);
  return *this;
}

HeaderBytes& HeaderBytes::add(std::string_view name, std::uint32_t value) {
  return add(name, bytesOf(value));
}

HeaderBytes& HeaderBytes::add(std::string_view name, std::uint64_t value) {
  return add(name, bytesOf(value));
}

HeaderBytes& HeaderBytes::add(std::string_view name, const ros::Time& value) {
  std::string time;
  appendTime(time, value);
  return add(name, std::string_view(time));
}

void appendTime(std::string& bytes, const ros::Time& time) {
  appendNumber(bytes, time.sec);
  appendNumber(bytes, time.nsec);
}

void appendNumber(std::string& bytes, std::uint32_t number) {
  bytes.append(bytesOf(number));
}

void appendRecordHead(std::string& bytes, const HeaderBytes& header, std::uint32_t data_size) {
  appendNumber(bytes, static_cast<std::uint32_t>(header.bytes().size()));
  bytes.append(header.bytes());
  appendNumber(bytes, data_size);
}

void appendRecord(std::string& bytes, const HeaderBytes& header, std::string_view data) {
  appendRecordHead(bytes, header, static_cast<std::uint32_t>(data.size()));
  bytes.append(data);
}

}  // namespace fast_edi
