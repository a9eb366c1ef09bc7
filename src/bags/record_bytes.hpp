/// \file
/// Records of the rosbag 2.0 format as bytes to be written; bag_record.hpp reads them.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include <ros/time.h>

#include "fast_edi/bags/bag_record.hpp"

namespace fast_edi {

/// The fields of a record's header, or of a connection's description.
class HeaderBytes {
 public:
  HeaderBytes() = default;
  explicit HeaderBytes(RecordKind kind);

  HeaderBytes& add(std::string_view name, std::string_view value);
  HeaderBytes& add(std::string_view name, std::uint32_t value);
  HeaderBytes& add(std::string_view name, std::uint64_t value);
  HeaderBytes& add(std::string_view name, const ros::Time& value);

  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

/// A time as records have it: seconds, nanoseconds.
void appendTime(std::string& bytes, const ros::Time& time);

void appendNumber(std::string& bytes, std::uint32_t number);

/// Header, and the length of the data, which are to follow.
void appendRecordHead(std::string& bytes, const HeaderBytes& header, std::uint32_t data_size);

/// \pre the data have less than 4 GiB
void appendRecord(std::string& bytes, const HeaderBytes& header, std::string_view data);

}  // namespace fast_edi
