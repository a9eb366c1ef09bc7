#include "fast_edi/config/parameters_from_yaml.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "fast_edi/config/parameter_table.hpp"
#include "support/temporary_directory.hpp"

namespace fast_edi {
namespace {

using ::testing::ContainsRegex;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;

const std::string kThresholds = "contrast_threshold_on: 0.3\ncontrast_threshold_off: 0.2\n";
const std::string kLibcaerBiases =
    "biases: {DiffBn_coarse: 4, DiffBn_fine: 39, OnBn_coarse: 5, OnBn_fine: 255, "
    "OffBn_coarse: 4, OffBn_fine: 1}\n";
const std::string kStockBiases =
    "biases: {DiffBn_coarse: 4, DiffBn_fine: 39, ONBn_coarse: 6, ONBn_fine: 200, "
    "OFFBn_coarse: 4, OFFBn_fine: 0}\n";

/// With everything that davis_ros_driver's own files have; values of its indoors.yaml.
const std::string kDriverSettings =
    "DiffBn_coarse: 2, DiffBn_fine: 39, OFFBn_coarse: 1, OFFBn_fine: 62, ONBn_coarse: 4, "
    "ONBn_fine: 200, PrBp_coarse: 3, PrBp_fine: 72, PrSFBp_coarse: 3, PrSFBp_fine: 96, "
    "RefrBp_coarse: 3, RefrBp_fine: 52, ADC_RefHigh_volt: 24, ADC_RefHigh_curr: 7, "
    "aps_enabled: true, dvs_enabled: true, autoexposure_enabled: false, exposure: 4000, "
    "frame_delay: 0, imu_acc_scale: 3, imu_enabled: true, imu_gyro_scale: 3, max_events: 0, "
    "streaming_rate: 30, background_activity_filter_enabled: true, refractory_period_time: 2, "
    "skip_every: 0, polarity_flatten: false, roi_start_row: 0, aps_roi_end_row: 259, "
    "pixel_0_row: 0, pixel_auto_train: false, groups: {id: 0}";

LoadedParameters load(const std::string& yaml) {
  return parametersFromYaml(YAML::Load(yaml), "");
}

std::string messageFor(const std::string& yaml) {
  try {
    load(yaml);
  } catch (const ParameterError& error) {
    return error.what();
  }
  return "accepted";
}

std::vector<std::string> linesOf(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    lines.push_back(line);
  }
  return lines;
}

TEST(ParametersFromYaml, DefaultsAreTheCodes) {
  const LoadedParameters loaded = load(kThresholds);
  const DeblurParameters defaults;
  EXPECT_EQ(loaded.deblur.weighting, defaults.weighting);
  EXPECT_EQ(loaded.deblur.reference, ExposureInstant::kMid);
  EXPECT_EQ(loaded.deblur.stamp_reference, ExposureInstant::kMid);
  EXPECT_EQ(loaded.deblur.exposure_source, ExposureSource::kTopic);
  EXPECT_EQ(loaded.deblur.exposure_time_ns, 0);
  EXPECT_EQ(loaded.deblur.time_offset_ns, 0);
  EXPECT_EQ(loaded.deblur.close_timeout_ns, 100 * kNanosecondsPerMillisecond);
  EXPECT_EQ(loaded.deblur.max_buffered_events, 13'000'000u);
  EXPECT_EQ(loaded.deblur.max_backward_jump_ns, 500 * kNanosecondsPerMillisecond);
  EXPECT_EQ(loaded.deblur.max_forward_jump_ns, 10 * kNanosecondsPerSecond);
  EXPECT_TRUE(loaded.deblur.response.isLinear());
  EXPECT_EQ(loaded.deblur.response.offsetDn(), 0.0);
  EXPECT_FALSE(loaded.deblur.passthrough);
  EXPECT_EQ(loaded.ros.frame_id, "");
  EXPECT_TRUE(loaded.ros.lazy);
  EXPECT_EQ(loaded.ros.learned_file, "");
}

TEST(ParametersFromYaml, ReadsEveryKeyInItsUnit) {
  const LoadedParameters loaded = load(
      kThresholds +
      "weighting: counter\nreference: start\nstamp_reference: end\nexposure_source: parameter\n"
      "exposure_time_us: 12345\ntime_offset_us: -1.5\nclose_timeout_ms: 50.5\n"
      "max_buffered_events: 1e6\nmax_backward_jump_ms: 20\nmax_forward_jump_ms: 3000\n"
      "latent_images: 8\nresponse_offset_dn: 4.5\nframe_id: davis\npassthrough: true\nlazy: "
      "false\nlearned_file: a.yaml\n");
  EXPECT_EQ(loaded.deblur.thresholds, (ContrastThresholds{0.3, 0.2}));
  EXPECT_EQ(loaded.deblur.weighting, Weighting::kCounter);
  EXPECT_EQ(loaded.deblur.reference, ExposureInstant::kStart);
  EXPECT_EQ(loaded.deblur.stamp_reference, ExposureInstant::kEnd);
  EXPECT_EQ(loaded.deblur.exposure_source, ExposureSource::kParameter);
  EXPECT_EQ(loaded.deblur.exposure_time_ns, 12'345'000);
  EXPECT_EQ(loaded.deblur.time_offset_ns, -1500);
  EXPECT_EQ(loaded.deblur.close_timeout_ns, 50'500'000);
  EXPECT_EQ(loaded.deblur.max_buffered_events, 1'000'000u);
  EXPECT_EQ(loaded.deblur.max_backward_jump_ns, 20'000'000);
  EXPECT_EQ(loaded.deblur.max_forward_jump_ns, 3'000'000'000);
  EXPECT_EQ(loaded.deblur.latent.per_exposure, 8);
  EXPECT_EQ(loaded.deblur.response.offsetDn(), 4.5);
  EXPECT_EQ(loaded.ros.frame_id, "davis");
  EXPECT_TRUE(loaded.deblur.passthrough);
  EXPECT_FALSE(loaded.ros.lazy);
  EXPECT_EQ(loaded.ros.learned_file, "a.yaml");
  EXPECT_EQ(loaded.contrast_origin, "contrast_threshold_on, contrast_threshold_off");
}

TEST(ParametersFromYaml, LongTimeOffsetsKeepTheirMicroseconds) {
  const std::string offset = "time_offset_us: 1597849200123457\n";
  EXPECT_EQ(load(kThresholds + offset).deblur.time_offset_ns, 1'597'849'200'123'457'000);
}

TEST(ParametersFromYaml, ThresholdsComeFromBiasesInEverySpelling) {
  const std::string driver =
      "biases: {DiffBn_coarse: 4, DiffBn_fine: 39, ONBn_coarse: 5, ONBn_fine: 255, "
      "OFFBn_coarse: 4, OFFBn_fine: 1}\n";
  const std::string flipped =
      "biases: {DiffBn_coarse: 3, DiffBn_fine: 39, OnBn_coarse: 2, OnBn_fine: 255, "
      "OffBn_coarse: 3, OffBn_fine: 1, coarse_convention: jaer_xml, capacitor_ratio: 20}\n";
  for (const std::string& yaml : {kLibcaerBiases, driver}) {
    const LoadedParameters loaded = load(yaml);
    EXPECT_NEAR(loaded.deblur.thresholds.on, 0.260911, 1e-5);
    EXPECT_NEAR(loaded.deblur.thresholds.off, 0.241554, 1e-5);
    EXPECT_EQ(loaded.contrast_origin, "biases");
    EXPECT_THAT(loaded.warnings, IsEmpty());
    ASSERT_TRUE(loaded.biases.has_value());
    EXPECT_EQ(loaded.biases->on.fine, 255);
  }
  const LoadedParameters jaer = load(flipped);
  EXPECT_NEAR(jaer.deblur.thresholds.on, 0.282653, 1e-5);
  EXPECT_NEAR(jaer.deblur.thresholds.off, 0.261683, 1e-5);
}

TEST(ParametersFromYaml, BiasesOfOneThresholdAreKeptForLater) {
  const std::string on_alone =
      "biases: {DiffBn_coarse: 4, DiffBn_fine: 39, OnBn_coarse: 5, OnBn_fine: 255}\n";
  EXPECT_TRUE(load("contrast_threshold_off: 0.2\n" + on_alone).biases);
  EXPECT_TRUE(load(kThresholds + on_alone).biases);
  EXPECT_FALSE(load(kThresholds + "biases: {DiffBn_coarse: 4, OnBn_coarse: 5}\n").biases);
}

TEST(ParametersFromYaml, AFaultyBiasIsTheOnlyFault) {
  EXPECT_THAT(linesOf(messageFor("biases: {DiffBn_coarse: 4, DiffBn_fine: 39, OnBn_coarse: 5, "
                                 "OnBn_fine: many, OffBn_coarse: 4, OffBn_fine: 1}\n")),
              SizeIs(1));
}

TEST(ParametersFromYaml, KappasScaleTheThresholds) {
  const double plain = load(kLibcaerBiases).deblur.thresholds.on;
  YAML::Node root = YAML::Load(kLibcaerBiases);
  root["biases"]["kappa_n"] = 0.35;
  EXPECT_NEAR(parametersFromYaml(root, "").deblur.thresholds.on, plain / 2.0, 1e-12);
  root["biases"]["kappa_p"] = 0.35;
  EXPECT_NEAR(parametersFromYaml(root, "").deblur.thresholds.on, plain * 2.0, 1e-12);
}

TEST(ParametersFromYaml, ExplicitThresholdsWin) {
  const LoadedParameters both = load(kThresholds + kLibcaerBiases);
  EXPECT_EQ(both.deblur.thresholds, (ContrastThresholds{0.3, 0.2}));
  EXPECT_FALSE(both.from_biases.on);
  EXPECT_FALSE(both.from_biases.off);

  const LoadedParameters one = load("contrast_threshold_off: 0.2\n" + kLibcaerBiases);
  EXPECT_NEAR(one.deblur.thresholds.on, 0.260911, 1e-5);
  EXPECT_EQ(one.deblur.thresholds.off, 0.2);
  EXPECT_EQ(one.contrast_origin, "biases, contrast_threshold_off");
}

TEST(ParametersFromYaml, StockDriverNeedsAnExplicitOffThreshold) {
  const std::string message = messageFor(kStockBiases);
  EXPECT_THAT(message, HasSubstr("OffBn"));
  EXPECT_THAT(message, HasSubstr("give contrast_threshold_off"));
  const LoadedParameters loaded = load("contrast_threshold_off: 0.4\n" + kStockBiases);
  EXPECT_NEAR(loaded.deblur.thresholds.on, 0.381999, 1e-5);
  EXPECT_EQ(loaded.deblur.thresholds.off, 0.4);
}

TEST(ParametersFromYaml, RefusesToGuessThresholds) {
  for (const std::string& yaml : {std::string(), std::string("weighting: time")}) {
    EXPECT_THAT(messageFor(yaml), HasSubstr("contrast_threshold_on: not given, nor biases"));
    EXPECT_THAT(messageFor(yaml), HasSubstr("contrast_threshold_off: not given, nor biases"));
  }
  const std::string half = messageFor("contrast_threshold_on: 0.3");
  EXPECT_THAT(linesOf(half), SizeIs(1));
  EXPECT_THAT(half, HasSubstr("contrast_threshold_off: not given"));
}

TEST(ParametersFromYaml, NamesMissingBiases) {
  const std::string message = messageFor("biases: {DiffBn_coarse: 4, OnBn_coarse: 5}");
  EXPECT_THAT(message, HasSubstr("DiffBn_fine, OnBn_fine missing"));
  EXPECT_THAT(message, HasSubstr("OffBn_coarse, OffBn_fine missing"));
  EXPECT_THAT(load(kThresholds + "biases: {kappa_n: 0.7}").contrast_origin,
              Not(HasSubstr("biases")));
}

TEST(ParametersFromYaml, UnknownKeysNameTheNearestKnownOne) {
  const std::map<std::string, std::string> meant = {
      {"contrast_treshold_on", "contrast_threshold_on"},
      {"Reference", "reference"},
      {"time_offset_ms", "time_offset_us"},
      {"exposure_us", "exposure_time_us"},
      {"bias", "biases"},
  };
  for (const auto& [wrong, right] : meant) {
    EXPECT_THAT(messageFor(kThresholds + wrong + ": 1"),
                HasSubstr(wrong + ": unknown, the nearest known key is " + right));
  }
  EXPECT_THAT(
      messageFor(kThresholds + "biases: {ONBn_course: 5}"),
      HasSubstr("biases/ONBn_course: unknown, the nearest known key is biases/ONBn_coarse"));
}

TEST(ParametersFromYaml, BiasesMayStandAmongTheDriversOtherSettings) {
  const LoadedParameters loaded = load("biases: {" + kDriverSettings + "}");
  EXPECT_NEAR(loaded.deblur.thresholds.on, 0.382070, 1e-5);
  EXPECT_NEAR(loaded.deblur.thresholds.off, 0.106891, 1e-5);
}

TEST(ParametersFromYaml, MisspeltBiasesAreNoSettingsOfTheDriver) {
  for (const char* wrong : {"ONBm_fine", "OFFBn_fien", "OfBn_coarse", "DifBn_fine", "Diffbn_fine",
                            "kapa_n", "coarse_conventions", "capacitor_ration"}) {
    EXPECT_THAT(messageFor("biases: {" + kDriverSettings + ", " + wrong + ": 1}"),
                HasSubstr("biases/" + std::string(wrong) + ": unknown, the nearest known key is"));
  }
  EXPECT_THAT(messageFor(kThresholds + "biases: {contrast: 1}"),
              HasSubstr("biases/contrast: unknown"));
  EXPECT_THAT(messageFor(kThresholds + "PrBp_coarse: 1"), HasSubstr("PrBp_coarse: unknown"));
}

TEST(ParametersFromYaml, KeysOfStepsThatDoNotExistAreUnknown) {
  for (const char* key : {"latent_video", "temporal_filter"}) {
    EXPECT_THAT(messageFor(kThresholds + key + ": 1"), HasSubstr(std::string(key) + ": unknown"));
  }
}

TEST(ParametersFromYaml, RefusesWrongTypesAndRanges) {
  const std::vector<std::pair<std::string, std::string>> wrong = {
      {"weighting: 3", "weighting: found '3', expected one of: time, counter"},
      {"reference: [mid]", "reference: found a list, expected one of: start, mid, end"},
      {"exposure_source: both", "expected one of: topic, parameter"},
      {"exposure_time_us: soon",
       "exposure_time_us: found 'soon', expected a number 0 or 1..1000000 [us]"},
      {"exposure_time_us: -1", "exposure_time_us: found '-1'"},
      {"exposure_time_us: 1000001", "exposure_time_us: found '1000001'"},
      {"time_offset_us: .nan", "time_offset_us: found '.nan'"},
      {"close_timeout_ms: 0", "close_timeout_ms: found '0', expected a number 1..60000 [ms]"},
      {"max_buffered_events: 0", "max_buffered_events: found '0', expected an integer"},
      {"max_buffered_events: 1.5", "max_buffered_events: found '1.5', expected an integer"},
      {"max_backward_jump_ms: 0", "max_backward_jump_ms"},
      {"max_forward_jump_ms: .inf", "max_forward_jump_ms: found '.inf'"},
      {"response_offset_dn: -1", "response_offset_dn: found '-1', expected a number 0..255 [DN]"},
      {"frame_id: {a: b}", "frame_id: found a map, expected a text"},
      {"passthrough: 1", "passthrough: found '1', expected true or false"},
      {"lazy:", "lazy: found nothing, expected true or false"},
      {"biases: ''", "biases: found '', expected a map or the path of a YAML file"},
      {"biases: {DiffBn_coarse: 8}", "biases/DiffBn_coarse: found '8', expected an integer 0..7"},
      {"biases: {OFFBn_fine: 256}", "biases/OffBn_fine: found '256', expected an integer 0..255"},
      {"biases: {coarse_convention: jaer}", "expected one of: libcaer, jaer_xml"},
      {"biases: {capacitor_ratio: 0}", "biases/capacitor_ratio: found '0'"},
      {"biases: {kappa_p: 2}", "biases/kappa_p: found '2'"},
      {"response_file: missing.txt", "response_file: missing.txt: cannot be read"},
  };
  for (const auto& [yaml, expected] : wrong) {
    const std::string message = messageFor(kThresholds + yaml);
    EXPECT_THAT(message, HasSubstr(expected));
    EXPECT_THAT(linesOf(message), SizeIs(1)) << message;
  }
  EXPECT_THAT(messageFor("contrast_threshold_on: 0\ncontrast_threshold_off: -0.2"),
              HasSubstr("contrast_threshold_on: found '0', expected a number 0.01..10"));
  EXPECT_THAT(messageFor("[1, 2]"), HasSubstr("the configuration is a list, expected a map"));
}

TEST(ParametersFromYaml, ListsAllFaultsAtOnce) {
  const std::vector<std::string> lines = linesOf(messageFor(
      "refrence: mid\nclose_timeout_ms: never\nlazy: maybe\n" + kStockBiases + "passthrough: 2\n"));
  EXPECT_THAT(lines, ElementsAre(HasSubstr("refrence: unknown"), HasSubstr("close_timeout_ms:"),
                                 HasSubstr("lazy:"), HasSubstr("passthrough:"),
                                 HasSubstr("give contrast_threshold_off")));
}

TEST(ParametersFromYaml, RefusesKeysGivenTwice) {
  EXPECT_THAT(messageFor(kThresholds + "lazy: true\nlazy: false"), HasSubstr("lazy: given twice"));
  EXPECT_THAT(messageFor(kThresholds + "biases: {ONBn_fine: 1, OnBn_fine: 1}"),
              HasSubstr("biases/OnBn_fine: given twice (spellings count as one)"));
}

TEST(ParametersFromYaml, WarnsOfUnusualThresholds) {
  EXPECT_THAT(load("contrast_threshold_on: 0.7\ncontrast_threshold_off: 0.3").warnings, SizeIs(2));
}

class ParametersFromFile : public ::testing::Test {
 protected:
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(directory_.file(name)) << text;
  }
  std::string messageForFile(const std::string& text) const {
    write("parameters.yaml", text);
    try {
      parametersFromFile(path_);
    } catch (const ParameterError& error) {
      return error.what();
    }
    return "accepted";
  }

  const TemporaryDirectory directory_;
  const std::string path_ = directory_.file("parameters.yaml");
};

TEST_F(ParametersFromFile, FaultsNameFileAndLine) {
  EXPECT_THAT(linesOf(messageForFile(kThresholds + "\nlazy: maybe\nframe: x\n")),
              ElementsAre(HasSubstr(path_ + ":4: lazy:"), HasSubstr(path_ + ":5: frame:")));
  EXPECT_THAT(messageForFile("a: b\n{"), HasSubstr(path_ + ":2: not YAML"));
  EXPECT_THAT(messageForFile(""), HasSubstr("contrast_threshold_on: not given"));
  EXPECT_THROW(parametersFromFile(directory_.file("nonexistent.yaml")), ParameterError);
}

TEST_F(ParametersFromFile, ResponseFileLiesBesideTheConfiguration) {
  std::string response;
  for (int dn = 0; dn < 256; ++dn) {
    response += std::to_string(std::log(dn + 5.0)) + "\n";
  }
  write("response.txt", response);
  write("parameters.yaml", kThresholds + "response_file: response.txt\n");
  EXPECT_FALSE(parametersFromFile(path_).deblur.response.isLinear());
  EXPECT_THAT(messageForFile(kThresholds + "response_file: response.txt\nresponse_offset_dn: 5\n"),
              HasSubstr("response_offset_dn: belongs to the linear response"));
}

TEST_F(ParametersFromFile, BiasesMayLieInAFileOfTheDriver) {
  write("indoors.yaml", "{" + kDriverSettings + "}\n");
  write("parameters.yaml", "biases: indoors.yaml\n");
  const LoadedParameters loaded = parametersFromFile(path_);
  EXPECT_NEAR(loaded.deblur.thresholds.on, 0.382070, 1e-5);
  EXPECT_NEAR(loaded.deblur.thresholds.off, 0.106891, 1e-5);
  EXPECT_EQ(loaded.contrast_origin, "biases");
}

TEST_F(ParametersFromFile, FaultsOfAFileOfBiasesNameThatFile) {
  const std::string biases = directory_.file("biases.yaml");
  const std::string text = "biases: biases.yaml\n";
  EXPECT_THAT(messageForFile(text),
              HasSubstr(path_ + ":1: biases: " + biases + ": cannot be read"));
  write("biases.yaml", "DiffBn_coarse: 4\nDiffBn_fine: 300\nONBnfine: 3\n");
  EXPECT_THAT(linesOf(messageForFile(text)),
              ElementsAre(HasSubstr(biases + ":2: biases/DiffBn_fine: found '300'"),
                          HasSubstr(biases + ":3: biases/ONBnfine: unknown")));
  write("biases.yaml", "DiffBn_coarse: 4\nDiffBn_fine: 39\n");
  EXPECT_THAT(messageForFile(text), HasSubstr("OnBn_coarse, OnBn_fine missing"));
  write("biases.yaml", "- 1\n");
  EXPECT_THAT(messageForFile(text), HasSubstr("found a list, expected a map of biases"));
  EXPECT_THAT(messageForFile("biases: [1]"),
              HasSubstr("biases: found a list, expected a map or the path of a YAML file"));
}

TEST_F(ParametersFromFile, RefusesOverridesOfWhatIsNoMap) {
  for (const char* text : {"no map", "[1, 2]"}) {
    write("parameters.yaml", text);
    for (const char* argument : {"lazy:=false", "biases/DiffBn_coarse:=3"}) {
      try {
        parametersFromFile(path_, {argument});
        FAIL() << text;
      } catch (const ParameterError& error) {
        EXPECT_THAT(error.what(), HasSubstr("expected a map"));
      }
    }
  }
}

TEST_F(ParametersFromFile, ReadsNoFurtherThanAConfigurationCanBeLong) {
  try {
    parametersFromFile("/dev/zero");
    FAIL();
  } catch (const ParameterError& error) {
    EXPECT_STREQ(error.what(), "/dev/zero: larger than 1 MB, expected a YAML file of parameters");
  }
}

TEST_F(ParametersFromFile, AConfigurationMayBeOneMegabyteLong) {
  constexpr std::size_t kMegabyte = 1 << 20;
  const std::string path = directory_.file("long.yaml");
  for (const std::size_t more : {0U, 1U}) {
    std::string text = kThresholds + "# ";
    text.resize(kMegabyte + more, 'x');
    std::ofstream(path) << text;
    std::string message = "accepted";
    try {
      parametersFromFile(path);
    } catch (const ParameterError& error) {
      message = error.what();
    }
    EXPECT_THAT(message, HasSubstr(more == 0 ? "accepted" : "larger than 1 MB"));
  }
}

TEST_F(ParametersFromFile, OverridesReplaceValuesOfTheFile) {
  write("parameters.yaml", kLibcaerBiases);
  const LoadedParameters loaded = parametersFromFile(
      path_, {"contrast_threshold_on:=0.36", "biases/OffBn_fine:=2", "frame_id:=", "lazy:=false"});
  EXPECT_EQ(loaded.deblur.thresholds.on, 0.36);
  EXPECT_EQ(loaded.biases->off.fine, 2);
  EXPECT_EQ(loaded.ros.frame_id, "");
  EXPECT_FALSE(loaded.ros.lazy);
}

TEST_F(ParametersFromFile, FaultsOfOverridesAreNotBlamedOnTheFile) {
  write("parameters.yaml", std::string(kThresholds) + "\nlazy: 3\n");
  try {
    parametersFromFile(path_, {"close_timeout_ms:=-3", "refference:=mid"});
    FAIL();
  } catch (const ParameterError& error) {
    EXPECT_THAT(error.what(), HasSubstr("key:=value: close_timeout_ms: found '-3'"));
    EXPECT_THAT(error.what(), HasSubstr("key:=value: refference: unknown"));
    EXPECT_THAT(error.what(), ContainsRegex("parameters.yaml:[0-9]+: lazy: found '3'"));
  }
}

TEST(ApplyOverrides, WorksOnAnEmptyMap) {
  YAML::Node root;
  applyOverrides(root, {"contrast_threshold_on:=0.36", "contrast_threshold_off:=0.3"});
  EXPECT_EQ(parametersFromYaml(root, "").deblur.thresholds, (ContrastThresholds{0.36, 0.3}));
}

TEST(ApplyOverrides, RefusesWhatIsNoOverride) {
  for (const char* wrong : {"lazy", "lazy=true", ":=true", "lazy:=[1", "weighting/a:=1"}) {
    YAML::Node root = YAML::Load("weighting: time");
    EXPECT_THROW(applyOverrides(root, {wrong}), ParameterError) << wrong;
  }
}

TEST(ParameterTable, ListsTheKeysInOrder) {
  std::vector<std::string> names;
  for (const ParameterDescription& key : parameterDescriptions()) {
    names.push_back(key.name);
    EXPECT_FALSE(key.doc.empty()) << key.name;
    EXPECT_FALSE(key.default_value.empty()) << key.name;
  }
  EXPECT_EQ(names, parameterKeys());
}

TEST(ParameterTable, DefaultsAreAcceptedAndChangeNothing) {
  YAML::Node root = YAML::Load(kThresholds);
  for (const ParameterDescription& key : parameterDescriptions()) {
    if (key.default_value != "none" && !root[key.name]) {
      root[key.name] = key.default_value == "\"\"" ? "" : key.default_value;
    }
  }
  const LoadedParameters loaded = parametersFromYaml(root, "");
  const DeblurParameters defaults;
  EXPECT_EQ(loaded.deblur.weighting, defaults.weighting);
  EXPECT_EQ(loaded.deblur.reference, defaults.reference);
  EXPECT_EQ(loaded.deblur.stamp_reference, defaults.stamp_reference);
  EXPECT_EQ(loaded.deblur.exposure_source, defaults.exposure_source);
  EXPECT_EQ(loaded.deblur.exposure_time_ns, defaults.exposure_time_ns);
  EXPECT_EQ(loaded.deblur.time_offset_ns, defaults.time_offset_ns);
  EXPECT_EQ(loaded.deblur.close_timeout_ns, defaults.close_timeout_ns);
  EXPECT_EQ(loaded.deblur.max_buffered_events, defaults.max_buffered_events);
  EXPECT_EQ(loaded.deblur.max_backward_jump_ns, defaults.max_backward_jump_ns);
  EXPECT_EQ(loaded.deblur.max_forward_jump_ns, defaults.max_forward_jump_ns);
  EXPECT_EQ(loaded.deblur.passthrough, defaults.passthrough);
  EXPECT_EQ(loaded.ros.lazy, RosParameters{}.lazy);
  EXPECT_FALSE(loaded.deblur.latent.isOn());
}

TEST(ParameterTable, IsAMarkdownTable) {
  const std::vector<std::string> lines = linesOf(markdownTable(biasDescriptions()));
  ASSERT_THAT(lines, SizeIs(2 + biasDescriptions().size()));
  EXPECT_EQ(lines[2],
            "| `DiffBn_coarse` | integer | 0..7 |  | none | coarse value of the differencing "
            "amplifier's bias |");
}

}  // namespace
}  // namespace fast_edi
