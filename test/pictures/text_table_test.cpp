#include "pictures/text_table.hpp"

#include <gmock/gmock.h>

#include <fstream>
#include <string>
#include <vector>

#include "support/temporary_directory.hpp"

namespace fast_edi {
namespace {

using ::testing::ElementsAre;

std::optional<std::int64_t> nanoseconds(const std::string& text, int unit) {
  const std::optional<Decimal> decimal = parseDecimal(text);
  return decimal ? decimal->scaled(unit) : std::nullopt;
}

TEST(TextTable, DecimalsLoseNothing) {
  EXPECT_EQ(nanoseconds("1700000000.035000001", kSeconds), 1'700'000'000'035'000'001);
  EXPECT_EQ(nanoseconds("1700000000035000001", kNanoseconds), 1'700'000'000'035'000'001);
  EXPECT_EQ(nanoseconds("0.003811000", kSeconds), 3'811'000);
  EXPECT_EQ(nanoseconds("3.811000000000000e+03", kMicroseconds), 3'811'000);
  EXPECT_EQ(nanoseconds("1.5E-3", kSeconds), 1'500'000);
  EXPECT_EQ(nanoseconds("-2", kMicroseconds), -2000);
  EXPECT_EQ(nanoseconds("0.5", kNanoseconds), 1);
  EXPECT_EQ(nanoseconds("0.00000000049", kSeconds), 0);
  EXPECT_EQ(nanoseconds("5", kNanoseconds), 5);
}

TEST(TextTable, WhatIsNoNumberIsNone) {
  for (const char* text : {"", "-", ".", "1e", "1.2.3", "0x10", "nan", "inf", "1 2", "1e99999",
                           "99999999999999999999999"}) {
    EXPECT_FALSE(parseDecimal(text)) << text;
  }
  EXPECT_FALSE(nanoseconds("1e300", kSeconds));
  EXPECT_FALSE(nanoseconds("99999999999", kSeconds));
}

TEST(TextTable, FieldsAreSplitAtAnySeparators) {
  std::vector<std::string_view> fields;
  splitFields(" 1,2;  3\t4\r", fields);
  // As strings: a GoogleTest built for C++11, as on Debian 11, has no matchers of views.
  EXPECT_THAT(std::vector<std::string>(fields.begin(), fields.end()),
              ElementsAre("1", "2", "3", "4"));
  splitFields("  ", fields);
  EXPECT_TRUE(fields.empty());
}

TEST(TextTable, NamesTellUnits) {
  EXPECT_EQ(parseColumnName("Stamp_us").name, "stamp");
  EXPECT_EQ(parseColumnName("Stamp_us").unit, kMicroseconds);
  EXPECT_EQ(parseColumnName("t[ns]").unit, kNanoseconds);
  EXPECT_EQ(parseColumnName("t_s").unit, kSeconds);
  EXPECT_EQ(parseColumnName("ts").name, "ts");
  EXPECT_FALSE(parseColumnName("ts").unit);
}

TEST(TextTable, LinesOfAnyLengthAreRead) {
  const TemporaryDirectory directory;
  const std::string path = directory.file("lines.txt");
  const std::string body(300'000, 'x');
  std::ofstream(path) << "first\n\n" << body << "\nlast";
  LineReader lines(openStream(path));
  EXPECT_EQ(lines.next(), "first");
  EXPECT_EQ(lines.next(), "");
  EXPECT_EQ(lines.next()->size(), LineReader::kMaxLineBytes);
  EXPECT_EQ(lines.number(), 3u);
  EXPECT_EQ(lines.offset(), 7u);
  EXPECT_EQ(lines.next(), "last");
  EXPECT_EQ(lines.offset(), 7u + body.size() + 1);
  EXPECT_FALSE(lines.next());
}

}  // namespace
}  // namespace fast_edi
