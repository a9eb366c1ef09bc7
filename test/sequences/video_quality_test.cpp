#include "sequences/video_quality.hpp"

#include <sstream>
#include <stdexcept>

#include <gmock/gmock.h>

#include "evaluation/message_of.hpp"

namespace fast_edi {
namespace {

using ::testing::HasSubstr;

/// \param scene 0 is shaken strongly, 1 mildly
EvaluationSequence shortSequence(std::size_t scene = 0) {
  EvaluationSequence sequence = evaluationSequences(4, 1)[scene];
  sequence.settings.sensor.size = {120, 90};
  sequence.settings.scene.tags = 1;
  sequence.settings.motion.focal_length_px = 110.0;
  return sequence;
}

VideoQuality qualityOf(const DeblurParameters& parameters, int images, int skip) {
  return videoQuality(shortSequence(), parameters, images, skip, [](int) {});
}

TEST(VideoQuality, MeasuresEachInstantOfEachExposure) {
  int done = 0;
  const VideoQuality quality =
      videoQuality(shortSequence(), {}, 5, 1, [&done](int frames) { done = frames; });
  EXPECT_EQ(done, 4);
  EXPECT_EQ(quality.name, "poster-strong/1");
  EXPECT_EQ(quality.frames, 3);
  ASSERT_EQ(quality.psnr_db.size(), 5U);
  for (const double psnr_db : quality.psnr_db) {
    EXPECT_GT(psnr_db, 15.0);
    EXPECT_LT(psnr_db, 50.0);
  }
  EXPECT_GE(quality.lossDb(), 0.0);
  EXPECT_GE(quality.largest_loss_db, quality.lossDb());
}

TEST(VideoQuality, TheMiddleImageIsTheDeblurredFrame) {
  EXPECT_DOUBLE_EQ(qualityOf({}, 1, 0).psnr_db.front(), qualityOf({}, 3, 0).psnr_db[1]);
  EXPECT_EQ(qualityOf({}, 1, 0).lossDb(), 0.0);
}

TEST(VideoQuality, FollowsTheParameters) {
  DeblurParameters plain;
  plain.filter.enabled = false;
  EXPECT_LT(qualityOf(plain, 1, 0).psnr_db.front(), qualityOf({}, 1, 0).psnr_db.front());
}

TEST(VideoQuality, GainsByMotionCompensationWhereverItIsNotTheMiddle) {
  DeblurParameters parameters;
  parameters.filter.reblur = false;  // images that are not stabilised do not know the frame's
  const VideoQuality with = videoQuality(shortSequence(1), parameters, 5, 1, [](int) {});
  parameters.filter.motion = false;
  const VideoQuality without = videoQuality(shortSequence(1), parameters, 5, 1, [](int) {});
  EXPECT_EQ(with.psnr_db[2], without.psnr_db[2]);
  for (const std::size_t end : {0U, 4U}) {
    EXPECT_GT(with.psnr_db[end], without.psnr_db[end] + 1.0);
  }
  EXPECT_LT(with.lossDb(), without.lossDb() - 1.0);
}

TEST(VideoQuality, WantsAMiddle) {
  for (const int images : {-1, 0, 4}) {
    EXPECT_THAT(messageOf<std::invalid_argument>([&] { qualityOf({}, images, 0); }),
                HasSubstr("expected an odd number, got " + std::to_string(images)));
  }
}

TEST(VideoQuality, IsPrintedAsATable) {
  std::ostringstream out;
  printVideoTable(out, {{"a", 2, {30.0, 33.5, 31.0}, 4.25}, {"b", 2, {32.0, 34.5, 33.0}, 2.5}});
  EXPECT_EQ(out.str(),
            "| PSNR [dB] at | 0.17 | 0.50 | 0.83 | loss | largest |\n"
            "|---|---:|---:|---:|---:|---:|\n"
            "| a | 30.00 | 33.50 | 31.00 | 3.50 | 4.25 |\n"
            "| b | 32.00 | 34.50 | 33.00 | 2.50 | 2.50 |\n"
            "| mean | 31.00 | 34.00 | 32.00 | 3.00 | 4.25 |\n");
}

}  // namespace
}  // namespace fast_edi
