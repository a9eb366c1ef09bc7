#include "stream/foreign_protocol.hpp"

namespace fast_edi {
namespace {

constexpr std::size_t kMaxShownBytes = 12;

bool startsWith(std::string_view text, std::string_view start) {
  return text.substr(0, start.size()) == start;
}

/// Type of a record, 20..23, and version 3.x (RFC 8446, 5.1).
bool isTls(std::string_view bytes) {
  constexpr char kFirstType = 20;
  constexpr char kLastType = 23;
  return bytes.size() >= 2 && bytes[0] >= kFirstType && bytes[0] <= kLastType && bytes[1] == 3;
}

}  // namespace

std::string describeForeign(std::string_view bytes) {
  if (isTls(bytes)) {
    return "TLS: encrypted streams are not supported; switch encryption off in DV";
  }
  if (startsWith(bytes, "#!AER-DAT")) {
    return "an AEDAT file";
  }
  if (startsWith(bytes, "HTTP/")) {
    return "the answer of a web server";
  }
  constexpr char kDigits[] = "0123456789abcdef";
  constexpr unsigned kDigitBits = 4;
  constexpr unsigned kDigitMask = 15;
  std::string text = bytes.empty() ? "nothing" : "the bytes";
  for (const char byte : bytes.substr(0, kMaxShownBytes)) {
    const auto value = static_cast<unsigned char>(byte);
    text += ' ';
    text += kDigits[value >> kDigitBits];
    text += kDigits[value & kDigitMask];
  }
  return text;
}

}  // namespace fast_edi
