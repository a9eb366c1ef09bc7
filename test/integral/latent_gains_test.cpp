#include "fast_edi/integral/latent_gains.hpp"
#include "fast_edi/integral/gain_limits.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "fast_edi/integral/double_integral.hpp"
#include "support/event_generators.hpp"

namespace fast_edi {
namespace {

constexpr SensorSize kSize{40, 30};
constexpr ContrastThresholds kThresholds{0.3, 0.25};
constexpr std::int64_t kMs = kNanosecondsPerMillisecond;
constexpr std::int64_t kStart = 1000 * kNanosecondsPerSecond;
constexpr ExposureInterval kExposure{kStart + 10 * kMs, kStart + 40 * kMs};

struct Model {
  Weighting weighting;
  LevelModel level;
};

/// The integral computed at each instant anew, from the same events.
class LatentGainsTest : public ::testing::TestWithParam<Model> {
 protected:
  LatentGainsTest() { lists_.keepIntervals(true); }

  void fill(testing::EventScene scene, std::size_t count) {
    lists_.append(testing::wireView(
        testing::toWire(testing::makeEvents(scene, {kSize, count, kStart, 60 * kMs, 7}))));
  }
  void append(const Event& event) { lists_.append(event); }

  std::vector<float> integrated(std::int64_t reference_ns) {
    DoubleIntegral integral(kSize, kThresholds, GetParam().weighting, GetParam().level);
    std::vector<float> gain(kSize.pixelCount());
    EXPECT_EQ(integral.integrate(lists_, kExposure, reference_ns, gain.data()).out_of_range, 0u);
    return gain;
  }

  void startAt(std::int64_t reference_ns) {
    const std::vector<float> gain = integrated(reference_ns);
    gains_.start(gain.data(), lists_, {reference_ns, kExposure.end_ns},
                 {kThresholds, GetParam().level});
  }

  std::vector<float> carried(std::int64_t t_ns, std::int64_t known_until_ns = kExposure.end_ns) {
    std::vector<float> gain(kSize.pixelCount());
    walked_ += gains_.at(lists_, {t_ns, known_until_ns}, gain.data());
    EXPECT_EQ(gains_.instant(), t_ns);
    return gain;
  }

  void expectAsIntegrated(std::int64_t t_ns) {
    const std::vector<float> expected = integrated(t_ns);
    const std::vector<float> gain = carried(t_ns);
    for (std::size_t i = 0; i < gain.size(); ++i) {
      ASSERT_NEAR(gain[i] / expected[i], 1.0F, 1e-6F) << "pixel " << i << ", " << t_ns - kStart;
    }
  }

  PixelEventLists lists_{kSize, {}};
  LatentGains gains_;
  std::uint64_t walked_ = 0;
};

TEST_P(LatentGainsTest, EqualTheIntegralAtEveryInstantOfTheExposure) {
  for (const testing::EventScene scene :
       {testing::EventScene::kUniform, testing::EventScene::kMovingEdges,
        testing::EventScene::kBursts}) {
    SCOPED_TRACE(testing::toString(scene));
    lists_.flush();
    fill(scene, 200'000);
    for (const ExposureInstant from :
         {ExposureInstant::kStart, ExposureInstant::kMid, ExposureInstant::kEnd}) {
      startAt(kExposure.at(from));
      for (std::int64_t t_ns = kExposure.start_ns; t_ns <= kExposure.end_ns; t_ns += 3 * kMs) {
        expectAsIntegrated(t_ns);
      }
    }
  }
}

TEST_P(LatentGainsTest, DoNotDependOnTheOrderOfInstants) {
  fill(testing::EventScene::kMovingEdges, 100'000);
  startAt(kExposure.at(ExposureInstant::kMid));
  for (const std::int64_t ms : {39, 12, 25, 25, 10, 40, 11}) {
    expectAsIntegrated(kStart + ms * kMs);
  }
}

TEST_P(LatentGainsTest, CountAnEventAtTheInstantAsLater) {
  append({3, 2, kExposure.start_ns + kMs, true});
  append({3, 2, kExposure.start_ns + 2 * kMs, false});
  for (const ExposureInstant from : {ExposureInstant::kStart, ExposureInstant::kEnd}) {
    startAt(kExposure.at(from));
    for (const std::int64_t off_ns : {-1, 0, 1}) {
      expectAsIntegrated(kExposure.start_ns + kMs + off_ns);
      expectAsIntegrated(kExposure.start_ns + 2 * kMs + off_ns);
    }
  }
}

TEST_P(LatentGainsTest, GoOnBeyondTheExposure) {
  append({3, 2, kExposure.start_ns - kMs, true});
  append({3, 2, kExposure.end_ns, true});
  append({3, 2, kExposure.end_ns + kMs, false});
  startAt(kExposure.at(ExposureInstant::kMid));
  const std::size_t pixel = 2 * 40 + 3;
  EXPECT_NEAR(carried(kExposure.start_ns - 9 * kMs)[pixel], std::exp(-0.3F), 1e-6F);
  EXPECT_NEAR(carried(kExposure.end_ns)[pixel], 1.0F, 1e-6F);
  EXPECT_NEAR(carried(kExposure.end_ns + 1)[pixel], std::exp(0.3F), 1e-6F);
  EXPECT_NEAR(carried(kExposure.end_ns + 2 * kMs)[pixel], std::exp(0.05F), 1e-6F);
}

TEST_P(LatentGainsTest, RiseTowardsTheNextEventThatIsKnown) {
  append({3, 2, kExposure.start_ns - kMs, true});
  append({3, 2, kExposure.end_ns + 2 * kMs, true});
  startAt(kExposure.at(ExposureInstant::kMid));
  const std::size_t pixel = 2 * 40 + 3;
  EXPECT_NEAR(carried(kExposure.end_ns)[pixel], 1.0F, 1e-6F);
  const LevelModel& level = GetParam().level;
  const double rise = level.isStaircase()
                          ? 0.0
                          : 0.3 * level.fraction *
                                (1.0 - 2.0 * static_cast<double>(kMs) /
                                           static_cast<double>(level.rampBefore(UINT16_MAX)));
  EXPECT_NEAR(carried(kExposure.end_ns, kExposure.end_ns + 3 * kMs)[pixel], std::exp(rise), 1e-6);
  EXPECT_NEAR(carried(kExposure.end_ns, kExposure.end_ns + 2 * kMs)[pixel], 1.0, 1e-6);
}

TEST_P(LatentGainsTest, LeavePixelsWithoutEventsAtExactlyOne) {
  append({3, 2, kExposure.start_ns + kMs, true});
  append({3, 2, kExposure.start_ns + 2 * kMs, true});
  startAt(kExposure.start_ns);
  const std::vector<float> gain = carried(kExposure.end_ns);
  EXPECT_NE(gain[2 * 40 + 3], 1.0F);
  EXPECT_EQ(std::count(gain.begin(), gain.end(), 1.0F),
            static_cast<std::ptrdiff_t>(gain.size() - 1));
}

TEST_P(LatentGainsTest, WalkEachEventOnceHoweverManyImagesThereAre) {
  fill(testing::EventScene::kUniform, 60'000);  // one each microsecond
  for (const int images : {1, 10, 300}) {
    startAt(kExposure.start_ns);
    walked_ = 0;
    for (int i = 1; i <= images; ++i) {
      carried(kExposure.start_ns + kExposure.length() * i / images);
    }
    EXPECT_EQ(walked_, lists_.lowerBound(kExposure.end_ns) - lists_.lowerBound(kExposure.start_ns));
  }
}

TEST_P(LatentGainsTest, StayWithinTheRangeOfGains) {
  for (int i = 0; i < 5000; ++i) {
    append({0, 0, kExposure.end_ns, true});
    append({1, 0, kExposure.end_ns, false});
  }
  startAt(kExposure.start_ns);
  const std::vector<float> gain = carried(kExposure.end_ns + 1);
  EXPECT_EQ(gain[0], static_cast<float>(kMaxGain));
  EXPECT_EQ(gain[1], static_cast<float>(kMinGain));
}

INSTANTIATE_TEST_SUITE_P(Models, LatentGainsTest,
                         ::testing::Values(Model{Weighting::kTime, {}},
                                           Model{Weighting::kCounter, {}},
                                           Model{Weighting::kTime, {4 * kMs, 0.85}}),
                         [](const ::testing::TestParamInfo<Model>& model) {
                           return model.param.weighting == Weighting::kCounter ? "Counter"
                                  : model.param.level.isStaircase()            ? "Time"
                                                                               : "Ramps";
                         });

}  // namespace
}  // namespace fast_edi
