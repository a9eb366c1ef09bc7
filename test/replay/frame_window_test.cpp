#include "replay/frame_window.hpp"

#include <gmock/gmock.h>

#include "fast_edi/bags/open_messages.hpp"
#include "fast_edi/bags/recording_messages.hpp"
#include "fast_edi/recording/recording_error.hpp"
#include "rostest/recording.hpp"
#include "support/temporary_directory.hpp"

namespace fast_edi {
namespace {

constexpr int kFrames = 60;
constexpr std::int64_t kMargin_ns = 100 * kNanosecondsPerMillisecond;

class FrameWindowTest : public ::testing::Test {
 protected:
  void SetUp() override {
    test::RecordingSettings settings;
    settings.frames = kFrames;
    recording_ = test::makeRecording(settings);
    test::writeBag(recording_, "/dvs", bag_);
    for (int i = 0; i < kFrames; ++i) {
      exposures_us_.push_back(i + 1);
    }
  }

  FrameWindow windowOf(const FrameWindow::Limits& limits) {
    return {[this] {
              ++opened_;
              return openMessages(bag_);
            },
            TopicNames{}, exposures_us_, limits};
  }

  static const ReplayItem* find(const FrameWindow& window, std::size_t frame) {
    for (const ReplayItem& item : window.items()) {
      if (item.frame && item.index == frame) {
        return &item;
      }
    }
    return nullptr;
  }

  /// Everything is there that a recording has from some frames before on.
  void expectAround(const FrameWindow& window, std::size_t frame, std::size_t before) {
    const std::size_t first = frame - std::min(frame, before);
    for (std::size_t i = first; i <= frame; ++i) {
      ASSERT_NE(find(window, i), nullptr) << i << " for " << frame;
    }
    const std::int64_t start_ns = window.recordTime(first) - kMargin_ns;
    const std::int64_t end_ns = window.recordTime(frame) + kMargin_ns;
    std::size_t expected = 0;
    for (const test::Arrival& arrival : recording_) {
      expected += arrival.events && arrival.time_ns >= start_ns && arrival.time_ns <= end_ns;
    }
    std::size_t found = 0;
    std::int64_t last_ns = 0;
    for (const ReplayItem& item : window.items()) {
      EXPECT_GE(item.record_ns, last_ns);
      last_ns = item.record_ns;
      found += !item.frame && item.record_ns >= start_ns && item.record_ns <= end_ns;
    }
    EXPECT_EQ(found, expected) << "arrays around " << frame;
  }

  TemporaryDirectory directory_;
  const std::string bag_ = directory_.file("recording.bag");
  test::Recording recording_;
  std::vector<std::int32_t> exposures_us_;
  int opened_ = 0;
};

TEST_F(FrameWindowTest, HoldsWhatLiesAroundAFrame) {
  FrameWindow window = windowOf({3, kMargin_ns});
  for (const std::size_t frame : {0, 1, 30, 31, 32, 59}) {
    ASSERT_TRUE(window.moveTo(frame));
    EXPECT_EQ(window.frame(), frame);
    expectAround(window, frame, 3);
  }
  EXPECT_EQ(opened_, 1);
}

TEST_F(FrameWindowTest, AFrameHasItsExposure) {
  FrameWindow window = windowOf({1, kMargin_ns});
  ASSERT_TRUE(window.moveTo(25));
  EXPECT_EQ(find(window, 25)->exposure_us, 26);
  EXPECT_EQ(find(window, 25)->frame->header.stamp, test::imagesOf(recording_)[25]->header.stamp);
}

TEST_F(FrameWindowTest, StepsBackInMemoryAndThenReadsAgain) {
  FrameWindow window = windowOf({3, kMargin_ns});
  ASSERT_TRUE(window.moveTo(50));
  std::size_t frame = 50;
  for (std::size_t i = 0; i < FrameWindow::kStepsBack; ++i) {
    ASSERT_TRUE(window.moveTo(--frame));
    expectAround(window, frame, 3);
  }
  EXPECT_EQ(opened_, 1);
  for (std::size_t i = 0; i < FrameWindow::kStepsBack; ++i) {
    ASSERT_TRUE(window.moveTo(--frame));
    expectAround(window, frame, 3);
  }
  EXPECT_EQ(opened_, 2);
}

TEST_F(FrameWindowTest, MemoryStaysThatOfTheFramesAround) {
  FrameWindow window = windowOf({3, kMargin_ns});
  ASSERT_TRUE(window.moveTo(25));
  const std::size_t bytes = window.bytes();
  ASSERT_TRUE(window.moveTo(55));
  EXPECT_LT(window.bytes(), bytes + bytes / 2);
  std::size_t counted = 0;
  for (const ReplayItem& item : window.items()) {
    counted += item.bytes();
  }
  EXPECT_EQ(window.bytes(), counted);
}

TEST_F(FrameWindowTest, AfterTooManyBytesTheFrameBeforeRemains) {
  FrameWindow window = windowOf({40, kMargin_ns, 20'000});
  for (const std::size_t frame : {40, 41, 50}) {
    ASSERT_TRUE(window.moveTo(frame));
    EXPECT_NE(find(window, frame), nullptr);
    EXPECT_NE(find(window, frame - 1), nullptr);
    EXPECT_EQ(find(window, frame - 20), nullptr);
  }
  EXPECT_EQ(opened_, 1);
  ASSERT_TRUE(window.moveTo(49));
  EXPECT_NE(find(window, 48), nullptr);
}

TEST_F(FrameWindowTest, SaysThatThereIsNoSuchFrame) {
  FrameWindow window = windowOf({3, kMargin_ns});
  EXPECT_FALSE(window.moveTo(kFrames));
  EXPECT_TRUE(window.moveTo(kFrames - 1));
  expectAround(window, kFrames - 1, 3);
}

TEST(FrameWindow, PassesOnWhyARecordingCannotBeOpened) {
  FrameWindow window([] { return openMessages(std::string("/nonexistent.bag")); }, TopicNames{}, {},
                     {});
  EXPECT_THROW(window.moveTo(0), RecordingError);
}

}  // namespace
}  // namespace fast_edi
