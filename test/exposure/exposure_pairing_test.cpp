#include "fast_edi/exposure/exposure_pairing.hpp"

#include <map>
#include <optional>

#include <gtest/gtest.h>

#include "fast_edi/base/types.hpp"

namespace fast_edi {
namespace {

constexpr std::int64_t kMs = kNanosecondsPerMillisecond;
constexpr std::int64_t kUs = kNanosecondsPerMicrosecond;
constexpr std::int64_t kTimeout = 100 * kMs;

class ExposurePairingTest : public ::testing::Test {
 protected:
  void image(std::uint64_t number, std::int64_t now_ms) {
    collect([&](auto& matches) { pairing.addImage(number, now_ms * kMs, matches); });
  }
  void message(std::int32_t exposure_us, std::int64_t now_ms) {
    collect([&](auto& matches) { pairing.addMessage(exposure_us, now_ms * kMs, matches); });
  }
  void advance(std::int64_t now_ms) {
    collect([&](auto& matches) { pairing.advance(now_ms * kMs, matches); });
  }

  /// Own length [us]; 0 when the image was left without; -1 while it waits.
  std::int64_t lengthOf(std::uint64_t number) const {
    const auto found = ended.find(number);
    return found == ended.end() ? -1 : found->second.value_or(0) / kUs;
  }

  DeblurCounters counters;
  ExposurePairing pairing{kTimeout, counters};
  std::map<std::uint64_t, std::optional<std::int64_t>> ended;

 private:
  template <typename Call>
  void collect(Call call) {
    std::vector<ExposureMatch> matches;
    call(matches);
    for (const ExposureMatch& match : matches) {
      EXPECT_TRUE(ended.emplace(match.image, match.length_ns).second)
          << "image " << match.image << " was matched twice";
    }
  }
};

TEST_F(ExposurePairingTest, TheNthMessageBelongsToTheNthImage) {
  image(0, 0);
  message(1000, 1);
  image(1, 40);
  EXPECT_EQ(lengthOf(1), -1);
  message(2000, 41);
  EXPECT_EQ(lengthOf(0), 1000);
  EXPECT_EQ(lengthOf(1), 2000);
  EXPECT_EQ(counters.exposures_in, 2u);
  EXPECT_EQ(counters.exposures_missing + counters.exposures_surplus, 0u);
}

TEST_F(ExposurePairingTest, AMessageMayOvertakeItsImage) {
  message(1000, 0);
  message(2000, 2);
  image(0, 3);
  image(1, 4);
  EXPECT_EQ(lengthOf(0), 1000);
  EXPECT_EQ(lengthOf(1), 2000);
}

TEST_F(ExposurePairingTest, ImagesMayPileUpBeforeTheirMessages) {
  image(0, 0);
  image(1, 40);
  image(2, 80);
  message(1000, 90);
  message(2000, 91);
  message(3000, 92);
  EXPECT_EQ(lengthOf(0), 1000);
  EXPECT_EQ(lengthOf(1), 2000);
  EXPECT_EQ(lengthOf(2), 3000);
}

TEST_F(ExposurePairingTest, AnImageWaitsExactlyTheTimeout) {
  image(0, 0);
  message(1000, 1);
  image(1, 40);
  advance(139);
  EXPECT_EQ(lengthOf(1), -1);
  advance(140);
  EXPECT_EQ(lengthOf(1), 0);
  EXPECT_EQ(counters.exposures_missing, 1u);
  EXPECT_EQ(pairing.last(), 1000 * kUs);
}

TEST_F(ExposurePairingTest, EachImageOfASilentTopicWaitsForItselfOnceTheTopicWasHeard) {
  image(0, 0);
  message(1000, 1);
  for (std::int64_t now_ms = 2; now_ms <= 400; ++now_ms) {
    advance(now_ms);
    if (now_ms % 40 == 0 && now_ms <= 200) {
      image(static_cast<std::uint64_t>(now_ms / 40), now_ms);
    }
    for (std::int64_t i = 1; i <= 5 && 40 * i <= now_ms; ++i) {
      EXPECT_EQ(lengthOf(static_cast<std::uint64_t>(i)), now_ms < 40 * i + 100 ? -1 : 0)
          << "image " << i << " at " << now_ms << " ms";
    }
  }
  EXPECT_EQ(counters.exposures_missing, 5u);
}

TEST_F(ExposurePairingTest, AMessageLostAtAShortPeriodIsFoundOutAndPairingStartsAnew) {
  image(0, 0);
  message(1000, 1);
  image(1, 40);  // its message is lost
  for (int i = 2; i < 8; ++i) {
    image(static_cast<std::uint64_t>(i), 40 * i);
    message(1000 * (i + 1), 40 * i + 1);
  }
  advance(400);
  EXPECT_EQ(counters.exposures_missing, 1u);
  EXPECT_EQ(counters.exposures_surplus, 0u);
  for (int i = 5; i < 8; ++i) {
    EXPECT_EQ(lengthOf(static_cast<std::uint64_t>(i)), 1000 * (i + 1)) << i;
  }
}

TEST_F(ExposurePairingTest, AnImageLostAtAShortPeriodIsFoundOutAndPairingStartsAnew) {
  message(1000, 1);  // its image is lost
  for (int i = 1; i < 8; ++i) {
    image(static_cast<std::uint64_t>(i), 40 * i);
    message(1000 * (i + 1), 40 * i + 1);
  }
  EXPECT_EQ(counters.exposures_surplus, 1u);
  EXPECT_EQ(counters.exposures_missing, 0u);
  for (int i = 5; i < 8; ++i) {
    EXPECT_EQ(lengthOf(static_cast<std::uint64_t>(i)), 1000 * (i + 1)) << i;
  }
}

TEST_F(ExposurePairingTest, MessagesThatAlwaysOvertakeTheirImagesAreNotSurplus) {
  for (int i = 0; i < 20; ++i) {
    message(1000 * (i + 1), 40 * i);
    image(static_cast<std::uint64_t>(i), 40 * i + 5);
    EXPECT_EQ(lengthOf(static_cast<std::uint64_t>(i)), 1000 * (i + 1)) << i;
  }
  EXPECT_EQ(counters.exposures_surplus, 0u);
}

TEST_F(ExposurePairingTest, AMessageWithoutImageIsSurplusAfterTheTimeout) {
  message(1000, 0);
  advance(100);
  EXPECT_EQ(counters.exposures_surplus, 1u);
  image(0, 120);
  EXPECT_EQ(lengthOf(0), -1);
  message(2000, 121);
  EXPECT_EQ(lengthOf(0), 2000);
}

TEST_F(ExposurePairingTest, NothingHeardWithinTheFirstTimeoutMakesLaterImagesNotWait) {
  image(0, 0);
  image(1, 40);
  advance(99);
  EXPECT_EQ(lengthOf(0), -1);
  advance(100);
  EXPECT_EQ(lengthOf(0), 0);
  EXPECT_EQ(lengthOf(1), 0);
  image(2, 120);
  EXPECT_EQ(lengthOf(2), 0);
}

TEST_F(ExposurePairingTest, AMessageEndsTheTimeOfNotWaiting) {
  image(0, 0);
  advance(100);
  image(1, 120);
  message(1000, 121);
  EXPECT_EQ(pairing.last(), 1000 * kUs);
  image(2, 160);
  EXPECT_EQ(lengthOf(2), -1);
  message(2000, 161);
  EXPECT_EQ(lengthOf(2), 2000);
  EXPECT_EQ(counters.exposures_surplus, 0u);
}

TEST_F(ExposurePairingTest, ValuesOutOfRangeAreRefusedAndKeepTheirPlaceInTheOrder) {
  int number = 0;
  for (const std::int32_t bad : {0, -5, 1'000'001, INT32_MIN, INT32_MAX}) {
    image(static_cast<std::uint64_t>(number), 40 * number);
    message(bad, 40 * number + 1);
    EXPECT_EQ(lengthOf(static_cast<std::uint64_t>(number)), 0) << bad;
    ++number;
  }
  EXPECT_FALSE(pairing.last());
  image(100, 400);
  message(1'000'000, 401);
  EXPECT_EQ(lengthOf(100), 1'000'000);
  EXPECT_EQ(counters.exposures_refused, 5u);
  EXPECT_EQ(counters.exposures_in, 6u);
  EXPECT_EQ(counters.exposures_missing + counters.exposures_surplus, 0u);
}

TEST_F(ExposurePairingTest, FinishEndsAllWaits) {
  message(500, 0);
  image(0, 1);
  image(1, 2);
  image(2, 3);
  std::vector<ExposureMatch> matches;
  pairing.finish(matches);
  ASSERT_EQ(matches.size(), 2u);
  EXPECT_EQ(matches[0].image, 1u);
  EXPECT_EQ(matches[1].image, 2u);
  EXPECT_FALSE(matches[0].length_ns);
  EXPECT_EQ(counters.exposures_missing, 2u);
}

TEST_F(ExposurePairingTest, RestartKeepsTheLastValueOnly) {
  image(0, 0);
  message(1000, 1);
  image(1, 2);
  pairing.restart();
  EXPECT_EQ(pairing.last(), 1000 * kUs);
  message(2000, 3);
  EXPECT_EQ(lengthOf(1), -1);
  image(2, 4);
  EXPECT_EQ(lengthOf(2), 2000);
}

TEST_F(ExposurePairingTest, MessagesWithoutImagesTakeNoMemory) {
  for (int i = 0; i < 10'000; ++i) {
    message(1000, 0);
  }
  EXPECT_GE(counters.exposures_surplus, 9'900u);
  advance(100);
  EXPECT_EQ(counters.exposures_surplus, 10'000u);
}

}  // namespace
}  // namespace fast_edi
