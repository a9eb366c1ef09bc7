/// \file
/// Tables of numbers and names in text: lines, fields, and decimal numbers without loss.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "recording/file_set.hpp"

namespace fast_edi {

/// Lines of a text, read block by block.
class LineReader {
 public:
  /// Longer lines come cut to this [bytes].
  static constexpr std::size_t kMaxLineBytes = 4096;

  explicit LineReader(std::unique_ptr<ByteStream> text) : text_(std::move(text)) {}

  /// The next line, without its end; nothing at the end of the text. Valid until the next call.
  std::optional<std::string_view> next();
  /// Number of the line that next() returned last, from 1.
  std::uint64_t number() const { return number_; }
  /// Where that line begins [bytes].
  std::uint64_t offset() const { return line_offset_; }
  std::uint64_t position() const { return block_offset_ + at_; }
  std::uint64_t size() const { return text_->size(); }
  /// Why the text ended early; empty if it did not.
  std::string fault() const { return text_->fault(); }

 private:
  bool readBlock();

  std::unique_ptr<ByteStream> text_;
  std::vector<std::uint8_t> block_;
  std::size_t block_bytes_ = 0;
  std::size_t at_ = 0;              ///< in the block
  std::uint64_t block_offset_ = 0;  ///< in the text
  std::uint64_t line_offset_ = 0;
  std::uint64_t number_ = 0;
  std::string cut_;  ///< a line that lies in two blocks
};

/// Splits at blanks, tabs, commas and semicolons; several in a row are one.
void splitFields(std::string_view line, std::vector<std::string_view>& fields);

/// A decimal number: mantissa * 10^exponent.
struct Decimal {
  std::int64_t mantissa = 0;
  int exponent = 0;

  double value() const;
  /// Times 10^\p shift, rounded to a whole number; nothing when it does not fit.
  std::optional<std::int64_t> scaled(int shift) const;
};

/// Nothing when \p text is not wholly a decimal number. Decimals that 63 bits
/// do not hold are dropped.
std::optional<Decimal> parseDecimal(std::string_view text);

/// Powers of ten from a unit of time to nanoseconds.
constexpr int kSeconds = 9;
constexpr int kMilliseconds = 6;
constexpr int kMicroseconds = 3;
constexpr std::size_t kAbsent = SIZE_MAX;  ///< place of a column that a table has not

constexpr int kNanoseconds = 0;

/// A column by its name, e.g. "t_us": lower case, without the unit at its end.
struct ColumnName {
  std::string name;
  std::optional<int> unit;  ///< where the name ends in _s, _ms, _us or _ns, or has it in brackets
};
ColumnName parseColumnName(std::string_view field);

}  // namespace fast_edi
