#include "fast_edi/events/event_coverage.hpp"

#include <gtest/gtest.h>

namespace fast_edi {
namespace {

constexpr std::int64_t kSlack = EventCoverage::kStartSlack_ns;
constexpr std::int64_t kFirst = 10 * kSlack;

EventCoverage startedAt(std::int64_t first_event_ns) {
  EventCoverage coverage;
  coverage.start(first_event_ns);
  return coverage;
}

TEST(EventCoverage, NothingIsCoveredBeforeTheStart) {
  EventCoverage coverage;
  EXPECT_FALSE(coverage.started());
  EXPECT_FALSE(coverage.covers({kFirst, kFirst + 10}));
}

TEST(EventCoverage, BeginsASlackBeforeTheFirstEvent) {
  const EventCoverage coverage = startedAt(kFirst);
  EXPECT_TRUE(coverage.covers({kFirst - kSlack, kFirst + 10}));
  EXPECT_FALSE(coverage.covers({kFirst - kSlack - 1, kFirst + 10}));
}

TEST(EventCoverage, AHoleTakesWhatOverlapsItAndNothingElse) {
  EventCoverage coverage = startedAt(kFirst);
  coverage.openHole(kFirst + 100);
  coverage.closeHole(kFirst + 200);
  EXPECT_TRUE(coverage.covers({kFirst, kFirst + 100}));
  EXPECT_FALSE(coverage.covers({kFirst, kFirst + 101}));
  EXPECT_FALSE(coverage.covers({kFirst + 199, kFirst + 300}));
  EXPECT_TRUE(coverage.covers({kFirst + 200, kFirst + 300}));
  EXPECT_FALSE(coverage.covers({kFirst, kFirst + 300}));
}

TEST(EventCoverage, AnOpenHoleHasNoEndYet) {
  EventCoverage coverage = startedAt(kFirst);
  coverage.openHole(kFirst + 100);
  coverage.openHole(kFirst + 150);  // more is lost: the hole stays the same
  EXPECT_TRUE(coverage.holeOpen());
  EXPECT_TRUE(coverage.covers({kFirst, kFirst + 100}));
  EXPECT_FALSE(coverage.covers({kFirst + 1000, kFirst + 2000}));
  EXPECT_FALSE(coverage.covers({kFirst, kFirst + 101}));
}

TEST(EventCoverage, AHoleBetweenEventsOfTheSameTimeTakesThatInstant) {
  EventCoverage coverage = startedAt(kFirst);
  coverage.openHole(kFirst + 100);
  coverage.closeHole(kFirst + 100);
  EXPECT_FALSE(coverage.covers({kFirst + 50, kFirst + 150}));
  EXPECT_TRUE(coverage.covers({kFirst + 101, kFirst + 150}));
}

TEST(EventCoverage, WhatWasDiscardedIsNotCovered) {
  EventCoverage coverage = startedAt(kFirst);
  coverage.discardBefore(kFirst + 100);
  EXPECT_FALSE(coverage.covers({kFirst + 99, kFirst + 200}));
  EXPECT_TRUE(coverage.covers({kFirst + 100, kFirst + 200}));
  coverage.discardBefore(kFirst);  // never goes back
  EXPECT_FALSE(coverage.covers({kFirst + 99, kFirst + 200}));
}

TEST(EventCoverage, RemembersWhereItBeganWhateverIsDiscarded) {
  EventCoverage coverage;
  EXPECT_FALSE(coverage.beganAfter(0));
  coverage.start(kFirst);
  EXPECT_TRUE(coverage.beganAfter(kFirst - kSlack - 1));
  EXPECT_FALSE(coverage.beganAfter(kFirst - kSlack));
  coverage.discardBefore(kFirst + 100);
  EXPECT_FALSE(coverage.beganAfter(kFirst));
}

TEST(EventCoverage, ManyHolesTakeTimeRatherThanMemory) {
  EventCoverage coverage = startedAt(kFirst);
  constexpr int kHoles = 1000;
  for (int i = 0; i < kHoles; ++i) {
    coverage.openHole(kFirst + 100 * i);
    coverage.closeHole(kFirst + 100 * i + 10);
  }
  EXPECT_FALSE(coverage.covers({kFirst + 20, kFirst + 90}));
  EXPECT_FALSE(coverage.covers({kFirst + 100 * (kHoles - 2) + 20, kFirst + 100 * kHoles}));
  EXPECT_TRUE(coverage.covers({kFirst + 100 * (kHoles - 2) + 20, kFirst + 100 * (kHoles - 1)}));
}

TEST(EventCoverage, ResetForgetsAll) {
  EventCoverage coverage = startedAt(kFirst);
  coverage.openHole(kFirst + 100);
  coverage.reset();
  EXPECT_FALSE(coverage.started());
  coverage.start(kFirst);
  EXPECT_TRUE(coverage.covers({kFirst, kFirst + 1000}));
}

}  // namespace
}  // namespace fast_edi
