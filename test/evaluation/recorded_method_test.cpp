#include "evaluation/recorded_method.hpp"

#include <gmock/gmock.h>

#include "evaluation/message_of.hpp"

namespace fast_edi {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr std::int64_t kSecond = 1'000'000'000;

cv::Mat grey(double value, cv::Size size = {6, 4}) {
  return {size, CV_8UC1, cv::Scalar(value)};
}

OtherMethod::Frame frame(std::int64_t stamp_ns, std::int64_t input_stamp_ns) {
  return {stamp_ns, input_stamp_ns, grey(1)};
}

TEST(RecordedMethod, TakesTheStampOfTheLatentImageBeforeThatOfTheFrame) {
  RecordedMethod method("theirs", "out.bag", {{kSecond, grey(10)}, {2 * kSecond, grey(20)}});
  EXPECT_EQ(method.deblur(frame(2 * kSecond, kSecond)).image.at<std::uint8_t>(0, 0), 20);
  EXPECT_EQ(method.deblur(frame(kSecond + 5'000'000, kSecond)).image.at<std::uint8_t>(0, 0), 10);
  EXPECT_THAT(method.notes(), IsEmpty());
}

TEST(RecordedMethod, MatchesWithinOneMicrosecond) {
  RecordedMethod method("theirs", "out.bag", {{kSecond, grey(10)}});
  EXPECT_FALSE(method.deblur(frame(kSecond + 1000, 0)).image.empty());
  EXPECT_FALSE(method.deblur(frame(kSecond - 1000, 0)).image.empty());
  EXPECT_TRUE(method.deblur(frame(kSecond + 1001, 0)).image.empty());
  EXPECT_TRUE(method.deblur(frame(kSecond - 1001, 0)).image.empty());
}

TEST(RecordedMethod, NamesWhatIsMissingAndWhatIsLeft) {
  RecordedMethod method("theirs", "out.bag /d", {{kSecond, grey(10)}, {5 * kSecond, grey(20)}});
  method.deblur(frame(kSecond, kSecond));
  method.deblur(frame(3 * kSecond + 40, 3 * kSecond + 40));
  EXPECT_THAT(
      method.notes(),
      ElementsAre("theirs: no frame in out.bag /d at 3.000000040 s: its means leave them "
                  "out",
                  "theirs: 1 of 2 frames in out.bag /d belong to no frame that was scored"));
}

TEST(RecordedMethod, ListsTheFirstTenOfManyMissingStamps) {
  RecordedMethod method("theirs", "out.bag", {});
  for (int i = 1; i <= 12; ++i) {
    method.deblur(frame(i * kSecond, i * kSecond));
  }
  EXPECT_THAT(method.notes(), ElementsAre(HasSubstr("10.000000000 s and 2 more:")));
}

TEST(RecordedMethod, RefusesFramesOfAnotherSizeOrEncoding) {
  RecordedMethod method("theirs", "out.bag", {{kSecond, grey(10, {8, 4})}, {2 * kSecond, {}}});
  EXPECT_THAT(
      messageOf<std::runtime_error>([&] { method.deblur(frame(kSecond, kSecond)); }),
      HasSubstr("theirs: out.bag: the frame at 1.000000000 s is 8x4, expected 6x4 as the input"));
  EXPECT_THAT(
      messageOf<std::runtime_error>([&] { method.deblur(frame(2 * kSecond, 2 * kSecond)); }),
      HasSubstr("of an encoding that is not known"));
}

}  // namespace
}  // namespace fast_edi
