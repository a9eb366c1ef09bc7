#include "sequences/sequence_sets.hpp"

#include <algorithm>
#include <fstream>
#include <set>
#include <string>

#include <gmock/gmock.h>

#include "support/temporary_directory.hpp"

namespace fast_edi {
namespace {

constexpr SequenceSet kBoth[] = {SequenceSet::kChoosing, SequenceSet::kJudging};
constexpr std::size_t kPhotographs[] = {4, 8};

/// All names of photographs that the two sets ask for, told by what is missing.
std::set<std::string> missingFiles(SequenceSet set) {
  std::set<std::string> files;
  for (const std::string& line : sequencesOf(set, 1, "/nonexistent").missing) {
    const std::size_t start = line.find("/nonexistent");
    files.insert(line.substr(start, line.find(' ', start) - start));
  }
  return files;
}

TEST(SequenceSetsTest, TogetherHaveFortySequencesWithoutAnyPhotograph) {
  std::size_t count = 0;
  std::set<std::string> names;
  for (const SequenceSet set : kBoth) {
    for (const SetSequence& entry : sequencesOf(set, 1, "/nonexistent").sequences) {
      ++count;
      names.insert(entry.sequence.name);
      EXPECT_NO_THROW(entry.sequence.settings.validate()) << entry.sequence.name;
      EXPECT_EQ(entry.sequence.for_tuning, set == SequenceSet::kChoosing);
      EXPECT_EQ(entry.sequence.settings.timing.frames, 1);
    }
  }
  EXPECT_GE(count, 40U);
  EXPECT_EQ(names.size(), count);
}

TEST(SequenceSetsTest, ShareNoTextureNoPhotographAndNoSeed) {
  std::set<TextureKind> textures[2];
  std::set<std::uint64_t> seeds[2];
  for (std::size_t i = 0; i < 2; ++i) {
    for (const SetSequence& entry : sequencesOf(kBoth[i], 1, "/nonexistent").sequences) {
      textures[i].insert(entry.sequence.settings.scene.texture);
      seeds[i].insert(entry.sequence.settings.seed);
    }
  }
  for (const TextureKind texture : textures[0]) EXPECT_EQ(textures[1].count(texture), 0U);
  for (const std::uint64_t seed : seeds[0]) EXPECT_EQ(seeds[1].count(seed), 0U);
  const std::set<std::string> choosing = missingFiles(SequenceSet::kChoosing);
  const std::set<std::string> judging = missingFiles(SequenceSet::kJudging);
  EXPECT_EQ(choosing.size(), kPhotographs[0]);
  EXPECT_EQ(judging.size(), kPhotographs[1]);
  for (const std::string& file : choosing) EXPECT_EQ(judging.count(file), 0U) << file;
}

TEST(SequenceSetsTest, EachCoversTheFactors) {
  for (const SequenceSet set : kBoth) {
    std::set<std::string> sensors;
    std::set<std::string> blurs;
    std::set<std::string> lights;
    std::set<std::string> contrasts;
    std::set<std::string> thresholds;
    double lowest = 1.0;
    double highest = 0.0;
    std::int64_t shortest_us = 1'000'000;
    std::int64_t longest_us = 0;
    for (const SetSequence& entry : sequencesOf(set, 2, "/nonexistent").sequences) {
      const SimulationSettings& settings = entry.sequence.settings;
      sensors.insert(entry.factors.sensor);
      blurs.insert(entry.factors.blur);
      lights.insert(entry.factors.light);
      contrasts.insert(entry.factors.contrast);
      thresholds.insert(entry.factors.thresholds);
      lowest = std::min({lowest, settings.sensor.thresholds.on, settings.sensor.thresholds.off});
      highest = std::max({highest, settings.sensor.thresholds.on, settings.sensor.thresholds.off});
      shortest_us = std::min(shortest_us, settings.timing.exposure_us);
      longest_us = std::max(longest_us, settings.timing.exposure_us);
      EXPECT_GE(entry.threshold_factor, 0.8);
      EXPECT_LE(entry.threshold_factor, 1.2);
      EXPECT_LE(settings.sensor.delay_us, 5'000);
    }
    EXPECT_THAT(sensors,
                testing::IsSupersetOf({"clean", "slow", "slow-noisy", "mismatch", "davis346",
                                       "davis240", "refractory", "delay", "hot", "flicker"}));
    EXPECT_THAT(blurs, testing::UnorderedElementsAre("< 3 px", "3-10 px", "> 10 px"));
    EXPECT_THAT(lights, testing::UnorderedElementsAre("bright", "dim", "saturated"));
    EXPECT_THAT(contrasts, testing::UnorderedElementsAre("full", "faint"));
    EXPECT_THAT(thresholds, testing::UnorderedElementsAre("right", "wrong"));
    EXPECT_DOUBLE_EQ(lowest, 0.15);
    EXPECT_DOUBLE_EQ(highest, 0.45);
    EXPECT_EQ(shortest_us, 5'000);
    EXPECT_EQ(longest_us, 60'000);
  }
}

TEST(SequenceSetsTest, PhotographsAreUsedWhereTheyAreAndNamedWhereNot) {
  const TemporaryDirectory directory;
  const std::string file = directory.file("mate/nature/Garden.jpg");
  std::filesystem::create_directories(directory.file("mate/nature"));
  std::ofstream(file) << "a picture";
  const SequenceSetContents contents = sequencesOf(SequenceSet::kChoosing, 1, directory.file(""));
  const auto garden = std::find_if(
      contents.sequences.begin(), contents.sequences.end(),
      [](const SetSequence& entry) { return entry.sequence.name == "photo-garden-slow"; });
  ASSERT_NE(garden, contents.sequences.end());
  EXPECT_TRUE(std::filesystem::equivalent(garden->sequence.settings.scene.texture_file, file));
  EXPECT_EQ(contents.missing.size(), kPhotographs[0] - 1);
  for (const std::string& missing : contents.missing) {
    EXPECT_THAT(missing, testing::HasSubstr("mate-backgrounds"));
  }
}

TEST(SequenceSetsTest, RefusesWhatIsNoSet) {
  EXPECT_THROW(sequencesOf(SequenceSet::kTwelve), std::invalid_argument);
  EXPECT_THROW(sequencesOf(SequenceSet::kChoosing, 0), std::invalid_argument);
  EXPECT_THROW(sequenceSetFromName("tuning"), std::invalid_argument);
  EXPECT_EQ(sequenceSetFromName("judging"), SequenceSet::kJudging);
}

}  // namespace
}  // namespace fast_edi
