#include "measures/brisque.hpp"

#include <fstream>
#include <stdexcept>

#include <gmock/gmock.h>

#include "evaluation/message_of.hpp"
#include "evaluation/test_images.hpp"
#include "measures/capability.hpp"

namespace fast_edi {
namespace {

using testing::HasSubstr;

TEST(BrisqueTest, NamesAMissingFile) {
  if (!isAvailable(OptionalLibrary::kOpencvQuality)) {
    EXPECT_THROW(Brisque("/nonexistent/model.yml", "/nonexistent/range.yml"), UnavailableError);
    return;
  }
  EXPECT_THAT(messageOf<std::runtime_error>(
                  [] { Brisque("/nonexistent/model.yml", "/nonexistent/range.yml"); }),
              HasSubstr("/nonexistent/model.yml"));
}

TEST(BrisqueTest, BlurAndNoiseRaiseTheScore) {
  if (!isAvailable(OptionalLibrary::kOpencvQuality) || !std::ifstream(kBrisqueModelFile)) {
    EXPECT_THROW(Brisque(), std::runtime_error);
    return;
  }
  const Brisque brisque;
  const cv::Mat sharp = withNoise(blurred(texturedImage({352, 256}), 0.7), 2.0);
  const double score = brisque.score(sharp);
  EXPECT_GE(score, 0.0);
  EXPECT_LE(score, 100.0);
  EXPECT_GT(brisque.score(blurred(sharp, 4.0)), score);
  EXPECT_GT(brisque.score(withNoise(sharp, 40.0)), score);
  EXPECT_EQ(brisque.score(sharp), score);
  EXPECT_THROW(brisque.score(cv::Mat()), std::invalid_argument);
}

}  // namespace
}  // namespace fast_edi
