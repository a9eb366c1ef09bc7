#include "recording/cdr_reader.hpp"

namespace fast_edi {
namespace {

/// Two bytes of representation (0: big endian, 1: little endian), two of options.
constexpr std::size_t kHeaderBytes = 4;
constexpr std::uint8_t kLittleEndian = 1;

}  // namespace

CdrReader::CdrReader(const std::uint8_t* data, std::size_t size) {
  if (size < kHeaderBytes || data[0] != 0 || data[1] > kLittleEndian) {
    ok_ = false;
    return;
  }
  body_ = data + kHeaderBytes;
  size_ = size - kHeaderBytes;
  big_endian_ = data[1] != kLittleEndian;
}

void CdrReader::align(std::size_t bytes) {
  const std::size_t aligned = (place_ + bytes - 1) / bytes * bytes;
  if (aligned > size_) {
    ok_ = false;
    return;
  }
  place_ = aligned;
}

std::string_view CdrReader::text() {
  const CdrBytes found = bytes();
  std::string_view text(reinterpret_cast<const char*>(found.data), found.size);
  return text.substr(0, text.find('\0'));
}

CdrBytes CdrReader::bytes() {
  const auto count = number<std::uint32_t>();
  if (!ok_ || count > rest()) {
    ok_ = false;
    return {};
  }
  const CdrBytes found{body_ + place_, count};
  place_ += count;
  return found;
}

CdrBytes CdrReader::availableBytes() {
  const auto count = number<std::uint32_t>();
  if (!ok_) {
    return {};
  }
  const CdrBytes found{body_ + place_, std::min<std::size_t>(count, rest())};
  ok_ = found.size == count;
  place_ += found.size;
  return found;
}

void CdrReader::doubles(double* values, std::size_t count) {
  std::generate_n(values, count, [this] { return number<double>(); });
}

void CdrReader::skipDoubles(std::size_t count) {
  align(sizeof(double));
  if (!ok_ || count > rest() / sizeof(double)) {
    ok_ = false;
    return;
  }
  place_ += count * sizeof(double);
}

}  // namespace fast_edi
