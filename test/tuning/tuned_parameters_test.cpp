#include "tuning/tuned_parameters.hpp"

#include <filesystem>
#include <fstream>
#include <stdexcept>

#include <gmock/gmock.h>

#include "support/temporary_directory.hpp"

namespace fast_edi {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

const std::string kConfig = FAST_EDI_SOURCE_DIR "/cfg/davis346.yaml";
const std::vector<std::string> kThresholds = {"contrast_threshold_on:=0.3",
                                              "contrast_threshold_off:=0.2"};

LoadedParameters load(const std::string& config, const std::vector<std::string>& overrides) {
  if (!config.empty()) {
    return parametersFromFile(config, overrides);
  }
  YAML::Node root(YAML::NodeType::Map);
  applyOverrides(root, overrides);
  return parametersFromYaml(root, ".");
}

TunedParameters tuned(const std::string& config, const std::vector<std::string>& overrides = {}) {
  return {config, overrides, load(config, overrides)};
}

TEST(TunedParameters, StartFromWhatIsGiven) {
  const TunedParameters parameters = tuned("", kThresholds);
  EXPECT_EQ(parameters.value("contrast_threshold_on"), 0.3);
  EXPECT_EQ(parameters.value("contrast_threshold_off"), 0.2);
  EXPECT_EQ(parameters.value("filter_gain_sigma_px"), 1.5);
  EXPECT_EQ(parameters.loaded().deblur.thresholds, (ContrastThresholds{0.3, 0.2}));
}

TEST(TunedParameters, ThresholdsFromBiasesBecomeNumbers) {
  const TunedParameters parameters = tuned(kConfig);
  const ContrastThresholds from_biases = parametersFromFile(kConfig).deblur.thresholds;
  EXPECT_NEAR(parameters.value("contrast_threshold_on"), from_biases.on, 5e-5);
  EXPECT_EQ(parameters.value("contrast_threshold_on"), parameters.loaded().deblur.thresholds.on);
  EXPECT_EQ(parameters.value("contrast_threshold_off"), parameters.loaded().deblur.thresholds.off);
}

TEST(TunedParameters, LearnNothing) {
  const DeblurParameters deblur = tuned(kConfig, {"refine_contrast:=true"}).loaded().deblur;
  EXPECT_FALSE(deblur.refine_contrast);
  EXPECT_FALSE(deblur.refine_delay);
}

TEST(TunedParameters, RefuseWhatIsOutOfRange) {
  TunedParameters parameters = tuned("", kThresholds);
  EXPECT_THAT(parameters.set("contrast_threshold_on", 20.0),
              AllOf(HasSubstr("contrast_threshold_on"), HasSubstr("0.01..10")));
  EXPECT_EQ(parameters.value("contrast_threshold_on"), 0.3);
  EXPECT_THAT(parameters.set("contrast_threshold_on", 0.4), IsEmpty());
  EXPECT_EQ(parameters.loaded().deblur.thresholds.on, 0.4);
  EXPECT_THROW(static_cast<void>(parameters.value("stamp_reference")), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(parameters.value("nonsense")), std::invalid_argument);
}

class TunedYaml : public ::testing::Test {
 protected:
  /// What the saved text is as a configuration.
  LoadedParameters reloaded(const TunedParameters& parameters) const {
    const std::string path = directory_.file("tuned.yaml");
    std::ofstream(path) << parameters.yaml();
    return parametersFromFile(path);
  }

  TemporaryDirectory directory_;
};

TEST_F(TunedYaml, IsTheSameConfiguration) {
  TunedParameters parameters =
      tuned(kConfig, {"time_offset_us:=-1500", "weighting:=counter", "frame_id:=''"});
  parameters.set("contrast_threshold_on", 0.41);
  parameters.set("filter_temporal", 0.3);
  const DeblurParameters loaded = reloaded(parameters).deblur;
  EXPECT_EQ(loaded.thresholds, parameters.loaded().deblur.thresholds);
  EXPECT_EQ(loaded.time_offset_ns, -1'500'000);
  EXPECT_EQ(loaded.weighting, Weighting::kCounter);
  EXPECT_EQ(loaded.filter.temporal, 0.3);
  EXPECT_FALSE(loaded.refine_contrast);
  EXPECT_FALSE(loaded.refine_delay);
  EXPECT_EQ(loaded.max_buffered_events, parameters.loaded().deblur.max_buffered_events);
}

TEST_F(TunedYaml, LeavesOutWhatIsAsByDefault) {
  EXPECT_THAT(tuned(kConfig).yaml(),
              AllOf(Not(HasSubstr("response_file")), Not(HasSubstr("max_buffered_events")),
                    Not(HasSubstr("filter")), HasSubstr("refine_contrast: false")));
}

TEST_F(TunedYaml, FindsTheResponseFileFromElsewhere) {
  const std::string folder = directory_.file("camera");
  std::filesystem::create_directory(folder);
  std::ofstream response(folder + "/response.txt");
  for (int dn = 0; dn < 256; ++dn) {
    response << 0.01 * dn << "\n";
  }
  response.close();
  const std::string config = folder + "/camera.yaml";
  std::ofstream(config) << "contrast_threshold_on: 0.3\ncontrast_threshold_off: 0.3\n"
                        << "response_file: response.txt\n";
  const TunedParameters parameters = tuned(config);
  EXPECT_THAT(parameters.yaml(), HasSubstr("response_file: " + folder + "/response.txt"));
  EXPECT_NO_THROW(reloaded(parameters));
}

TEST(TunedOverrides, AreWhatDiffersFromTheFile) {
  TunedParameters parameters =
      tuned(kConfig, {"stamp_reference:=start", "weighting:=counter", "time_offset_us:=0"});
  parameters.set("contrast_threshold_on", 0.41);
  const std::vector<std::string> words = parameters.overrides();
  EXPECT_THAT(
      words, AllOf(Contains("contrast_threshold_on:=0.41"), Contains("stamp_reference:=start"),
                   Contains("weighting:=counter"), Contains("refine_contrast:=false"),
                   Not(Contains(HasSubstr("time_offset_us"))), Not(Contains(HasSubstr("biases")))));
  const DeblurParameters again = parametersFromFile(kConfig, words).deblur;
  EXPECT_EQ(again.thresholds, parameters.loaded().deblur.thresholds);
  EXPECT_EQ(again.stamp_reference, ExposureInstant::kStart);
  EXPECT_EQ(again.weighting, Weighting::kCounter);
}

TEST(TunedOverrides, AreAllOfItWithoutAFile) {
  EXPECT_THAT(tuned("", kThresholds).overrides(),
              ElementsAre("contrast_threshold_on:=0.3", "contrast_threshold_off:=0.2",
                          "refine_contrast:=false", "refine_delay:=false"));
}

}  // namespace
}  // namespace fast_edi
