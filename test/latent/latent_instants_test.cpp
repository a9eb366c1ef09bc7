#include "fast_edi/latent/latent_instants.hpp"
#include "fast_edi/base/parameter_ranges.hpp"

#include <stdexcept>

#include <gmock/gmock.h>

namespace fast_edi {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

LatentSampling perExposure(int images) {
  LatentSampling sampling;
  sampling.per_exposure = images;
  return sampling;
}

LatentSampling film(int rate_hz) {
  LatentSampling sampling;
  sampling.per_exposure = 3;  // the rate wins
  sampling.rate_hz = rate_hz;
  return sampling;
}

TEST(LatentInstants, AreTheMiddlesOfEqualPartsOfTheExposure) {
  EXPECT_THAT(instantsWithin({1000, 2000}, perExposure(4)), ElementsAre(1125, 1375, 1625, 1875));
  EXPECT_THAT(instantsWithin({1000, 2000}, perExposure(1)), ElementsAre(1500));
  EXPECT_THAT(instantsWithin({1000, 2000}, perExposure(0)), IsEmpty());
}

TEST(LatentInstants, IncreaseStrictlyInTheShortestExposure) {
  const auto instants = instantsWithin({5000, 6000}, perExposure(kMaxLatentImages));
  ASSERT_EQ(instants.size(), static_cast<std::size_t>(kMaxLatentImages));
  EXPECT_GE(instants.front(), 5000);
  EXPECT_LT(instants.back(), 6000);
  for (std::size_t i = 1; i < instants.size(); ++i) {
    ASSERT_LT(instants[i - 1], instants[i]);
  }
}

TEST(LatentInstants, GoOnAsDenselyInTheGap) {
  EXPECT_THAT(instantsBetween({2000, 2500}, 1000, perExposure(4)), ElementsAre(2125, 2375));
  EXPECT_THAT(instantsBetween({2000, 2100}, 1000, perExposure(4)), IsEmpty());
  EXPECT_THAT(instantsBetween({2000, 1900}, 1000, perExposure(4)), IsEmpty());
}

TEST(LatentInstants, DoNotFloodALongGap) {
  EXPECT_THAT(instantsBetween({1000, 101'000}, 1000, perExposure(2)), ElementsAre(26'000, 76'000));
}

TEST(LatentInstants, OfAFilmAreMultiplesOfItsPeriod) {
  constexpr std::int64_t kMs = kNanosecondsPerMillisecond;
  const std::int64_t day_ns = 1'700'000'000 * kNanosecondsPerSecond;
  EXPECT_THAT(instantsWithin({day_ns, day_ns + 5 * kMs}, film(500)),
              ElementsAre(day_ns, day_ns + 2 * kMs, day_ns + 4 * kMs));
  EXPECT_THAT(instantsBetween({day_ns + kMs, day_ns + 6 * kMs}, kMs, film(500)),
              ElementsAre(day_ns + 2 * kMs, day_ns + 4 * kMs));
  EXPECT_THAT(instantsBetween({day_ns + 3 * kMs, day_ns + kMs}, kMs, film(500)), IsEmpty());
}

TEST(LatentInstants, NumbersAndInstantsOfAFilmAreInverse) {
  for (const int rate_hz : {1, 3, 500, 999, kMaxLatentRate_hz}) {
    for (const std::int64_t second : {std::int64_t{0}, std::int64_t{1'700'000'000}}) {
      for (std::int64_t i = 0; i < 2 * rate_hz; i += 1 + rate_hz / 7) {
        const std::int64_t number = second * rate_hz + i;
        const std::int64_t t_ns = filmInstant(number, rate_hz);
        ASSERT_EQ(firstFilmNumber(t_ns, rate_hz), number);
        ASSERT_EQ(firstFilmNumber(t_ns - 1, rate_hz), number);
        ASSERT_EQ(firstFilmNumber(t_ns + 1, rate_hz), number + 1);
      }
    }
  }
}

TEST(LatentInstants, RangesAreChecked) {
  EXPECT_NO_THROW(validate(perExposure(kMaxLatentImages)));
  EXPECT_THROW(validate(perExposure(kMaxLatentImages + 1)), std::invalid_argument);
  EXPECT_THROW(validate(perExposure(-1)), std::invalid_argument);
  EXPECT_THROW(validate(film(kMaxLatentRate_hz + 1)), std::invalid_argument);
  EXPECT_THROW(validate(film(-1)), std::invalid_argument);
}

}  // namespace
}  // namespace fast_edi
