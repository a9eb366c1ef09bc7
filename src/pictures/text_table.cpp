#include "pictures/text_table.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

namespace fast_edi {
namespace {

constexpr std::size_t kBlockBytes = std::size_t{1} << 18;
/// One more digit fits into 63 bits.
constexpr std::int64_t kMostBeforeDigit = (std::numeric_limits<std::int64_t>::max() - 9) / 10;
/// Numbers beyond are none that a recording holds.
constexpr int kMaxExponent = 400;

bool isSeparator(char c) {
  return c == ' ' || c == '\t' || c == ',' || c == ';' || c == '\r';
}

bool isDigit(char c) {
  return c >= '0' && c <= '9';
}

}  // namespace

bool LineReader::readBlock() {
  block_offset_ += block_bytes_;
  at_ = 0;
  block_.resize(kBlockBytes);
  block_bytes_ = text_->read(block_.data(), block_.size());
  return block_bytes_ > 0;
}

std::optional<std::string_view> LineReader::next() {
  cut_.clear();
  bool begun = false;
  for (;;) {
    if (at_ == block_bytes_ && !readBlock()) {
      if (!begun) {
        return std::nullopt;
      }
      return cut_;
    }
    if (!begun) {
      begun = true;
      line_offset_ = position();
      ++number_;
    }
    const char* const begin = reinterpret_cast<const char*>(block_.data()) + at_;
    const void* const end = std::memchr(begin, '\n', block_bytes_ - at_);
    const std::size_t length = end != nullptr
                                   ? static_cast<std::size_t>(static_cast<const char*>(end) - begin)
                                   : block_bytes_ - at_;
    at_ += length + (end != nullptr ? 1 : 0);
    if (end != nullptr && cut_.empty()) {
      return std::string_view(begin, std::min(length, kMaxLineBytes));
    }
    cut_.append(begin, std::min(length, kMaxLineBytes - cut_.size()));
    if (end != nullptr) {
      return cut_;
    }
  }
}

void splitFields(std::string_view line, std::vector<std::string_view>& fields) {
  fields.clear();
  std::size_t at = 0;
  while (at < line.size()) {
    while (at < line.size() && isSeparator(line[at])) {
      ++at;
    }
    const std::size_t begin = at;
    while (at < line.size() && !isSeparator(line[at])) {
      ++at;
    }
    if (at > begin) {
      fields.push_back(line.substr(begin, at - begin));
    }
  }
}

double Decimal::value() const {
  return static_cast<double>(mantissa) * std::pow(10.0, exponent);
}

std::optional<std::int64_t> Decimal::scaled(int shift) const {
  std::int64_t number = mantissa;
  int power = exponent + shift;
  for (; power > 0 && number != 0; --power) {
    if (std::abs(number) > std::numeric_limits<std::int64_t>::max() / 10) {
      return std::nullopt;
    }
    number *= 10;
  }
  int last = 0;  // digit that was dropped last
  for (; power < 0 && (number != 0 || last != 0); ++power) {
    last = static_cast<int>(number % 10);
    number /= 10;
  }
  return number + (last >= 5 ? 1 : last <= -5 ? -1 : 0);
}

std::optional<Decimal> parseDecimal(std::string_view text) {
  Decimal decimal;
  std::size_t at = 0;
  const bool negative = !text.empty() && text[0] == '-';
  if (negative || (!text.empty() && text[0] == '+')) {
    ++at;
  }
  bool any = false;
  bool fraction = false;
  for (; at < text.size(); ++at) {
    const char c = text[at];
    if (c == '.' && !fraction) {
      fraction = true;
      continue;
    }
    if (!isDigit(c)) {
      break;
    }
    any = true;
    if (decimal.mantissa <= kMostBeforeDigit) {
      decimal.mantissa = decimal.mantissa * 10 + (c - '0');
      decimal.exponent -= fraction ? 1 : 0;
    } else if (!fraction) {
      return std::nullopt;
    }
  }
  if (any && at < text.size() && (text[at] == 'e' || text[at] == 'E')) {
    ++at;
    const bool down = at < text.size() && text[at] == '-';
    if (down || (at < text.size() && text[at] == '+')) {
      ++at;
    }
    int exponent = 0;
    const std::size_t begin = at;
    for (; at < text.size() && isDigit(text[at]) && exponent <= kMaxExponent; ++at) {
      exponent = exponent * 10 + (text[at] - '0');
    }
    if (at == begin || exponent > kMaxExponent) {
      return std::nullopt;
    }
    decimal.exponent += down ? -exponent : exponent;
  }
  if (!any || at != text.size()) {
    return std::nullopt;
  }
  decimal.mantissa = negative ? -decimal.mantissa : decimal.mantissa;
  return decimal;
}

ColumnName parseColumnName(std::string_view field) {
  ColumnName column;
  for (const char c : field) {
    column.name += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  static constexpr std::array<std::pair<const char*, int>, 4> kUnits = {
      {{"ns", kNanoseconds}, {"us", kMicroseconds}, {"ms", kMilliseconds}, {"s", kSeconds}}};
  for (const auto& [unit, power] : kUnits) {
    for (const std::string& ending :
         {std::string("_") + unit, std::string("[") + unit + "]", std::string("(") + unit + ")"}) {
      std::string& name = column.name;
      if (!column.unit && name.size() > ending.size() &&
          name.compare(name.size() - ending.size(), ending.size(), ending) == 0) {
        name.resize(name.size() - ending.size());
        column.unit = power;
      }
    }
  }
  return column;
}

}  // namespace fast_edi
