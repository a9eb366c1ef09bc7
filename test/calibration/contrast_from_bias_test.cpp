#include "fast_edi/calibration/contrast_from_bias.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

namespace fast_edi {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// A bias as libcaer counts coarse values; jAER's XML stores them flipped.
BiasSetting as(CoarseConvention convention, BiasSetting libcaer) {
  return convention == CoarseConvention::kJaerXml ? BiasSetting{7 - libcaer.coarse, libcaer.fine}
                                                  : libcaer;
}

struct CurrentCase {
  BiasSetting bias;
  double libcaer_A;
  double jaer_A;
};

TEST(BiasCurrent, FollowsLibcaerAndJaer) {
  const std::vector<CurrentCase> cases = {
      {{0, 255}, 1.100000e-11, 1.182497e-11}, {{2, 225}, 6.670588e-10, 6.677628e-10},
      {{4, 1}, 1.899490e-10, 1.899414e-10},   {{4, 39}, 7.408012e-09, 7.407715e-09},
      {{4, 138}, 2.621296e-08, 2.621191e-08}, {{5, 255}, 3.875000e-07, 3.874805e-07},
      {{6, 200}, 2.431373e-06, 2.431250e-06}, {{7, 255}, 2.480000e-05, 2.479875e-05},
  };
  constexpr double kRelative = 1e-6;
  for (const CurrentCase& expected : cases) {
    SCOPED_TRACE(std::to_string(expected.bias.coarse) + "," + std::to_string(expected.bias.fine));
    EXPECT_NEAR(biasCurrent(expected.bias, CoarseConvention::kLibcaer), expected.libcaer_A,
                kRelative * expected.libcaer_A);
    EXPECT_NEAR(
        biasCurrent(as(CoarseConvention::kJaerXml, expected.bias), CoarseConvention::kJaerXml),
        expected.jaer_A, kRelative * expected.jaer_A);
  }
}

TEST(BiasCurrent, IsNotRoundedToPicoamperes) {
  EXPECT_GT(biasCurrent({0, 1}, CoarseConvention::kLibcaer), 0.0);
  EXPECT_EQ(biasCurrent({7, 0}, CoarseConvention::kLibcaer), 0.0);
}

TEST(BiasCurrent, RefusesWhatNoChipHas) {
  for (const BiasSetting bias :
       {BiasSetting{-1, 0}, BiasSetting{8, 0}, BiasSetting{0, -1}, BiasSetting{0, 256}}) {
    for (const auto convention : {CoarseConvention::kLibcaer, CoarseConvention::kJaerXml}) {
      EXPECT_THROW(biasCurrent(bias, convention), std::invalid_argument);
    }
  }
}

struct ThresholdCase {
  std::string origin;
  BiasSetting diff;
  BiasSetting on;
  BiasSetting off;
  ContrastThresholds libcaer;  ///< capacitor ratio 130/6
  ContrastThresholds jaer;     ///< capacitor ratio 20
};

std::vector<ThresholdCase> thresholdCases() {
  return {
      {"libcaer DAVIS346", {4, 39}, {5, 255}, {4, 1}, {0.260911, 0.241554}, {0.282653, 0.261683}},
      {"jAER Davis346", {4, 138}, {6, 45}, {2, 225}, {0.200328, 0.242053}, {0.217021, 0.262145}},
      {"jAER DAVIS240C", {4, 92}, {6, 48}, {2, 160}, {0.231317, 0.237797}, {0.250593, 0.257536}},
      {"rpg indoors", {2, 39}, {4, 200}, {1, 62}, {0.382070, 0.106891}, {0.413831, 0.115419}},
      {"rpg calib", {5, 255}, {6, 255}, {3, 20}, {0.137106, 0.442057}, {0.148532, 0.478887}},
  };
}

constexpr double kThresholdTolerance = 1e-5;

BiasConfiguration configurationOf(const ThresholdCase& biases, CoarseConvention convention) {
  BiasConfiguration configuration;
  configuration.diff = as(convention, biases.diff);
  configuration.on = as(convention, biases.on);
  configuration.off = as(convention, biases.off);
  configuration.convention = convention;
  if (convention == CoarseConvention::kJaerXml) {
    configuration.capacitor_ratio = 20.0;
  }
  return configuration;
}

TEST(ContrastFromBias, ReproducesTheWorkedThresholds) {
  for (const ThresholdCase& expected : thresholdCases()) {
    SCOPED_TRACE(expected.origin);
    const ContrastThresholds libcaer =
        contrastFromBias(configurationOf(expected, CoarseConvention::kLibcaer));
    EXPECT_NEAR(libcaer.on, expected.libcaer.on, kThresholdTolerance);
    EXPECT_NEAR(libcaer.off, expected.libcaer.off, kThresholdTolerance);
    const ContrastThresholds jaer =
        contrastFromBias(configurationOf(expected, CoarseConvention::kJaerXml));
    EXPECT_NEAR(jaer.on, expected.jaer.on, kThresholdTolerance);
    EXPECT_NEAR(jaer.off, expected.jaer.off, kThresholdTolerance);
  }
}

TEST(ContrastFromBias, GainFollowsTheCapacitorRatio) {
  BiasConfiguration configuration;
  EXPECT_NEAR(contrastGain(configuration), 0.0659341, 1e-7);
  configuration.capacitor_ratio = 20.0;
  EXPECT_NEAR(contrastGain(configuration), 0.0714286, 1e-7);
}

template <typename Call>
std::string messageOf(const Call& call) {
  try {
    call();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "nothing was thrown";
}

std::string messageFor(const BiasConfiguration& configuration) {
  return messageOf([&] { contrastFromBias(configuration); });
}

/// What the stock ROS driver ships: OffBn fine = 0.
ThresholdCase stockDriver() {
  return {"stock driver", {4, 39}, {6, 200}, {4, 0}, {0.381999, 0.0}, {0.413831, 0.0}};
}

TEST(ContrastFromBias, OffBiasWithoutCurrentNeedsAnExplicitThreshold) {
  for (const auto convention : {CoarseConvention::kLibcaer, CoarseConvention::kJaerXml}) {
    const BiasConfiguration configuration = configurationOf(stockDriver(), convention);
    EXPECT_THAT(messageFor(configuration), HasSubstr("OffBn"));
    EXPECT_THAT(messageFor(configuration), HasSubstr("give contrast_threshold_off"));

    NeededThresholds on_only;
    on_only.off = false;
    const ContrastThresholds thresholds = contrastFromBias(configuration, on_only);
    const double expected =
        convention == CoarseConvention::kLibcaer ? stockDriver().libcaer.on : stockDriver().jaer.on;
    EXPECT_NEAR(thresholds.on, expected, kThresholdTolerance);
    EXPECT_EQ(thresholds.off, 0.0);
  }
}

TEST(ContrastFromBias, NamesTheBiasAndTheRule) {
  BiasConfiguration good = configurationOf(thresholdCases().front(), CoarseConvention::kLibcaer);

  BiasConfiguration bad = good;
  bad.diff.coarse = 8;
  bad.on.fine = 256;
  bad.off.fine = -1;
  const std::string ranges = messageFor(bad);
  EXPECT_THAT(ranges, HasSubstr("DiffBn: coarse is 8, expected 0..7"));
  EXPECT_THAT(ranges, HasSubstr("OnBn: fine is 256, expected 0..255"));
  EXPECT_THAT(ranges, HasSubstr("OffBn: fine is -1, expected 0..255"));

  bad = good;
  bad.diff.fine = 0;
  EXPECT_THAT(messageFor(bad), HasSubstr("DiffBn (coarse 4, fine 0) has no current"));

  bad = good;
  bad.on = good.diff;
  bad.off = good.diff;
  EXPECT_THAT(messageFor(bad), HasSubstr("expected I_d < I_ON"));
  EXPECT_THAT(messageFor(bad), HasSubstr("expected I_OFF < I_d"));

  // The rule of a bias that nobody asks for does not matter.
  EXPECT_EQ(contrastFromBias(bad, {false, false}), ContrastThresholds{});
}

TEST(ContrastFromBias, RefusesConstantsThatAreNotPositive) {
  for (const double wrong : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    BiasConfiguration configuration =
        configurationOf(thresholdCases().front(), CoarseConvention::kLibcaer);
    configuration.capacitor_ratio = wrong;
    configuration.kappa_n = wrong;
    configuration.kappa_p = wrong;
    const std::string message = messageFor(configuration);
    for (const char* name : {"capacitor_ratio is ", "kappa_n is ", "kappa_p is "}) {
      EXPECT_THAT(message, HasSubstr(name));
    }
  }
}

TEST(ContrastWarnings, TellWhatIsUnusual) {
  EXPECT_THAT(contrastWarnings({0.26, 0.24}), IsEmpty());
  EXPECT_THAT(contrastWarnings({0.6, 0.3}), IsEmpty());
  EXPECT_THAT(contrastWarnings({0.05, 0.1}), IsEmpty());
  EXPECT_THAT(contrastWarnings({0.049, 0.06}), ElementsAre(HasSubstr("ON contrast threshold is")));
  EXPECT_THAT(contrastWarnings({0.5, 0.61}), ElementsAre(HasSubstr("OFF contrast threshold is")));
  EXPECT_THAT(contrastWarnings({0.382070, 0.106891}), ElementsAre(HasSubstr("ratio of ON to OFF")));
  EXPECT_THAT(contrastWarnings({0.1, 0.3}), ElementsAre(HasSubstr("ratio of ON to OFF")));
}

}  // namespace
}  // namespace fast_edi
