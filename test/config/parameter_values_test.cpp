/// Whatever value the configuration accepts, the pipeline works with it: at the start, and changed
/// while frames are deblurred.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fast_edi/config/live_parameters.hpp"
#include "fast_edi/config/parameter_table.hpp"
#include "fast_edi/config/parameters_from_yaml.hpp"
#include "fast_edi/pipeline/deblurrer.hpp"
#include "support/event_generators.hpp"
#include "support/pipeline_input.hpp"
#include "support/random_schedule.hpp"

namespace fast_edi {
namespace {

using testing::chance;
using ::testing::IsEmpty;
using testing::Random;
using testing::uniform;

constexpr std::int64_t kMs = kNanosecondsPerMillisecond;
constexpr SensorSize kSize{20, 20};  // fits its frames however it is turned
constexpr std::int64_t kPeriod_ns = 25 * kMs;
constexpr std::size_t kEventsPerPeriod = 3000;

double uniformNumber(Random& random, double lowest, double highest) {
  constexpr std::int64_t kSteps = 1'000'000;
  const double part = static_cast<double>(uniform(random, 0, kSteps)) / kSteps;
  return lowest + part * (highest - lowest);
}

/// Often an end of the range, else anywhere: small values as often as large ones.
double anyNumber(Random& random, const NumberRange& range) {
  if (range.or_zero && chance(random, 15)) {
    return 0.0;
  }
  if (chance(random, 30)) {
    return chance(random, 50) ? range.lowest : range.highest;
  }
  if (range.lowest > 0.0 && chance(random, 70)) {
    return std::clamp(
        std::exp(uniformNumber(random, std::log(range.lowest), std::log(range.highest))),
        range.lowest, range.highest);
  }
  return uniformNumber(random, range.lowest, range.highest);
}

std::string anyWord(Random& random, const std::string& words) {
  std::vector<std::string> choices;
  std::istringstream list(words);
  for (std::string word; std::getline(list, word, ',');) {
    choices.push_back(word.substr(word.find_first_not_of(' ')));
  }
  return choices[static_cast<std::size_t>(
      uniform(random, 0, static_cast<std::int64_t>(choices.size()) - 1))];
}

std::string anyValue(Random& random, const ParameterDescription& key) {
  if (!key.limits) {
    return anyWord(random, key.range);
  }
  const double number = anyNumber(random, *key.limits);
  return scalarText(key.type == "integer" ? std::round(number) : number);
}

bool takesAValue(const ParameterDescription& key) {
  return key.type != "text" && key.type != "map";
}

/// A texture that moves while each frame is exposed, and the events of its edges.
class Camera {
 public:
  /// One frame with its exposure and the events up to its end.
  void sendFrame(Random& random, Deblurrer& deblurrer) {
    testing::EventSpec spec{kSize, kEventsPerPeriod, now_ns_, kPeriod_ns, ++seed_};
    const auto scene = chance(random, 70) ? testing::EventScene::kMovingEdges
                                          : static_cast<testing::EventScene>(uniform(random, 0, 5));
    const std::vector<std::uint8_t> records = testing::toWire(testing::makeEvents(scene, spec));
    deblurrer.addFrame(testing::makeFrame(now_ns_ + kPeriod_ns / 2, kSize,
                                          testing::makeGreyImage(kSize, seed_ % 3)),
                       now_ns_);
    deblurrer.addExposure(static_cast<std::int32_t>(uniform(random, 1, 12'000)), now_ns_);
    now_ns_ += kPeriod_ns;
    deblurrer.addEvents(testing::wireView(records), kSize, sequence_++, now_ns_);
    deblurrer.advance(now_ns_);
  }

 private:
  std::int64_t now_ns_ = kNanosecondsPerSecond;
  std::uint64_t seed_ = 0;
  std::uint32_t sequence_ = 1;
};

bool isSane(const DeblurStatus& status) {
  return std::isfinite(status.thresholds.on) && status.thresholds.on > 0.0 &&
         std::isfinite(status.thresholds.off) && status.thresholds.off > 0.0;
}

/// Lets frames be deblurred, whatever else is set, and takes no time to show nothing new.
const LiveParameters::Values kTempered = {{"passthrough", "false"},
                                          {"time_offset_us", "0"},
                                          {"latent_images", "20"},
                                          {"close_timeout_ms", "100"},
                                          {"exposure_source", "topic"}};

/// Random values for all keys that a start reads, in random order.
YAML::Node anyStart(Random& random) {
  std::vector<ParameterDescription> keys = parameterDescriptions();
  std::shuffle(keys.begin(), keys.end(), random);
  YAML::Node root;
  for (const ParameterDescription& key : keys) {
    if (takesAValue(key)) {
      root[key.name] = anyValue(random, key);
    }
  }
  if (chance(random, 50)) {
    for (const auto& [name, text] : kTempered) {
      root[name] = text;
    }
  }
  return root;
}

LiveParameters::Values anyChange(Random& random) {
  LiveParameters::Values wanted;
  for (const ParameterDescription& key : parameterDescriptions()) {
    if (key.live && chance(random, 25)) {
      wanted[key.name] = anyValue(random, key);
    }
  }
  if (chance(random, 80)) {
    for (const auto& [name, text] : kTempered) {
      wanted[name] = text;
    }
  }
  return wanted;
}

TEST(ParameterValues, WhatAStartAcceptsTheCoreAcceptsAndWorksWith) {
  constexpr std::uint64_t kStarts = 60;
  std::uint64_t deblurred = 0;
  for (std::uint64_t seed = 0; seed < kStarts; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const YAML::Node root = anyStart(random);
    const LoadedParameters loaded = parametersFromYaml(root, "");
    testing::RecordingSink sink;
    Deblurrer deblurrer(loaded.deblur, sink);
    Camera camera;
    for (int frame = 0; frame < 4; ++frame) {
      camera.sendFrame(random, deblurrer);
      ASSERT_TRUE(isSane(deblurrer.status()));
    }
    deblurrer.finish();
    ASSERT_TRUE(sink.isBalanced());
    deblurred += deblurrer.counters().frames_deblurred;
  }
  EXPECT_GT(deblurred, kStarts / 4);
}

TEST(ParameterValues, WhatIsChangedLiveIsInForceAndTheNextChangeWorks) {
  const YAML::Node root = YAML::Load("{contrast_threshold_on: 0.3, contrast_threshold_off: 0.25}");
  std::uint64_t deblurred = 0;
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    LiveParameters live(parametersFromYaml(root, ""), root);
    testing::RecordingSink sink;
    sink.wants_latent_images = true;
    Deblurrer deblurrer(live.loaded().deblur, sink);
    Camera camera;
    for (int step = 0; step < 40; ++step) {
      LiveParameters::Values expected = live.values();
      const LiveParameters::Values wanted = anyChange(random);
      for (const auto& [name, text] : wanted) {
        expected[name] = text;
      }
      ASSERT_THAT(live.change(wanted), IsEmpty());
      ASSERT_EQ(live.values(), expected);
      ASSERT_NO_THROW(deblurrer.setParameters(live.loaded().deblur));
      camera.sendFrame(random, deblurrer);
      ASSERT_TRUE(isSane(deblurrer.status()));
      sink.latent_images.clear();
    }
    deblurrer.finish();
    ASSERT_TRUE(sink.isBalanced());
    deblurred += deblurrer.counters().frames_deblurred;
  }
  EXPECT_GT(deblurred, 40u);
}

/// Each alone, so that no other value hides what it does.
TEST(ParameterValues, BothEndsOfEachRangeLeaveAStillSceneAsItIs) {
  for (const ParameterDescription& key : parameterDescriptions()) {
    if (!key.limits || !key.live || key.name == "exposure_time_us") {
      continue;
    }
    for (const double value : {key.limits->lowest, key.limits->highest}) {
      SCOPED_TRACE(key.name + " " + scalarText(value));
      YAML::Node root = YAML::Load(
          "{contrast_threshold_on: 0.3, contrast_threshold_off: 0.25, exposure_source: parameter, "
          "exposure_time_us: 10000}");
      root[key.name] = scalarText(value);
      testing::RecordingSink sink;
      Deblurrer deblurrer(parametersFromYaml(root, "").deblur, sink);
      deblurrer.addFrame(testing::makeFlatFrame(kNanosecondsPerSecond, kSize), 0);
      deblurrer.finish();
      ASSERT_EQ(sink.outputs.size(), 1u);
      EXPECT_EQ(sink.outputs.front().pixels, std::vector<std::uint8_t>(kSize.pixelCount(), 100));
    }
  }
}

/// Values that are none: nothing in them can be told from 0.
TEST(ParameterValues, NumbersTooSmallToMeanAnythingAreRefused) {
  for (const char* name : {"contrast_threshold_on", "contrast_threshold_off", "exposure_time_us",
                           "close_timeout_ms", "max_backward_jump_ms", "max_forward_jump_ms",
                           "filter_gain_noise", "filter_gain_sigma_px", "frame_noise_dn"}) {
    for (const double value : {1e-7, 1e-20, 1e-46, 1e-300}) {
      SCOPED_TRACE(std::string(name) + " " + scalarText(value));
      YAML::Node root = YAML::Load("{contrast_threshold_on: 0.3, contrast_threshold_off: 0.25}");
      root[name] = scalarText(value);
      EXPECT_THROW(parametersFromYaml(root, ""), ParameterError);
    }
  }
}

TEST(ParameterValues, ThresholdsFromBiasesHaveTheSameRange) {
  const std::string biases =
      "biases: {DiffBn_coarse: 4, DiffBn_fine: 39, OnBn_coarse: 5, OnBn_fine: 255, "
      "OffBn_coarse: 4, OffBn_fine: 1, ";
  for (const char* extreme : {"capacitor_ratio: 1, kappa_p: 0.1", "capacitor_ratio: 1000"}) {
    try {
      parametersFromYaml(YAML::Load(biases + extreme + "}"), "");
      ADD_FAILURE() << extreme << " was accepted";
    } catch (const ParameterError& error) {
      EXPECT_THAT(error.what(), ::testing::HasSubstr("from these biases contrast_threshold_on is"));
      EXPECT_THAT(error.what(), ::testing::HasSubstr("expected 0.01..10"));
    }
  }
}

}  // namespace
}  // namespace fast_edi
