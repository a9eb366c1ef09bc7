/// \file
/// `contrast_from_bias`: the bias currents and contrast thresholds behind a configuration file.

#include <iomanip>
#include <iostream>
#include <string>
#include <vector>

#include <boost/program_options.hpp>

#include "command_line.hpp"
#include "fast_edi/calibration/contrast_from_bias.hpp"
#include "fast_edi/config/parameters_from_yaml.hpp"

namespace {

namespace po = boost::program_options;

namespace tools = fast_edi::tools;

constexpr int kNameWidth = 12;
constexpr int kValueWidth = 8;
constexpr int kNumberWidth = 14;

struct Arguments {
  std::string file;
  std::vector<std::string> overrides;
};

/// \return false when help was asked for and given
bool parseArguments(int argc, char** argv, Arguments& arguments) {
  po::options_description visible("Options");
  visible.add_options()("help,h", "print this");
  std::vector<std::string> words;
  auto values = tools::readCommandLine(
      argc, argv, visible,
      {"Usage: contrast_from_bias FILE.yaml [key:=value ...]\n\n"
       "Prints the bias currents and contrast thresholds that a configuration stands for, "
       "e.g. of\ncfg/davis346.yaml, or that the driver's own file of biases stands for. "
       "Values given as\nkey:=value replace those of the file, "
       "e.g. biases/OnBn_fine:=200.\n",
       "0 thresholds printed (warnings included); 1 wrong arguments, or a configuration that "
       "cannot\nbe used."},
      &words);
  if (!values) {
    return false;
  }
  po::notify(*values);
  if (words.empty()) {
    throw po::error("expected a configuration file");
  }
  arguments.file = words.front();
  arguments.overrides.assign(words.begin() + 1, words.end());
  return true;
}

void printBias(const std::string& name, const fast_edi::BiasSetting& bias,
               fast_edi::CoarseConvention convention) {
  std::cout << std::left << std::setw(kNameWidth) << name << std::right << std::setw(kValueWidth)
            << bias.coarse << std::setw(kValueWidth) << bias.fine << std::scientific
            << std::setprecision(6) << std::setw(kNumberWidth + 4)
            << fast_edi::biasCurrent(bias, convention) << "\n"
            << std::defaultfloat;
}

void printBiases(const fast_edi::BiasConfiguration& biases) {
  const bool jaer = biases.convention == fast_edi::CoarseConvention::kJaerXml;
  std::cout << std::left << std::setw(kNameWidth) << "bias" << std::right << std::setw(kValueWidth)
            << "coarse" << std::setw(kValueWidth) << "fine" << std::setw(kNumberWidth + 4)
            << "current [A]"
            << "\n";
  printBias("DiffBn", biases.diff, biases.convention);
  printBias("OnBn", biases.on, biases.convention);
  printBias("OffBn", biases.off, biases.convention);
  std::cout << "coarse values as in " << (jaer ? "jAER's XML" : "libcaer") << "\n\n"
            << "K = kappa_n / (kappa_p^2 C1/C2) = " << fast_edi::contrastGain(biases)
            << "   (kappa_n " << biases.kappa_n << ", kappa_p " << biases.kappa_p << ", C1/C2 "
            << biases.capacitor_ratio << ")\n\n";
}

void printThreshold(const std::string& name, double threshold, bool from_biases) {
  std::cout << std::left << std::setw(kNameWidth) << name << std::right << std::fixed
            << std::setprecision(6) << std::setw(kNumberWidth) << threshold << "   "
            << (from_biases ? "from biases" : "given") << "\n"
            << std::defaultfloat;
}

/// A file of the driver's has the biases at its top level, where a configuration has them in a map.
bool isDriversFile(const std::string& path) {
  try {
    const YAML::Node root = YAML::LoadFile(path);
    return root.IsMap() && root["DiffBn_coarse"].IsDefined();
  } catch (const YAML::Exception&) {
    return false;  // what is wrong with it is said when it is read as a configuration
  }
}

fast_edi::LoadedParameters load(const Arguments& arguments) {
  if (!isDriversFile(arguments.file)) {
    return fast_edi::parametersFromFile(arguments.file, arguments.overrides);
  }
  YAML::Node root(YAML::NodeType::Map);
  root["biases"] = arguments.file;
  fast_edi::applyOverrides(root, arguments.overrides);
  return fast_edi::parametersFromYaml(root, ".");
}

void run(const Arguments& arguments) {
  const fast_edi::LoadedParameters parameters = load(arguments);
  if (parameters.biases) {
    printBiases(*parameters.biases);
  }
  std::cout << std::left << std::setw(kNameWidth) << "threshold" << std::right
            << std::setw(kNumberWidth) << "natural log"
            << "\n";
  const fast_edi::ContrastThresholds& thresholds = parameters.deblur.thresholds;
  printThreshold("C_ON", thresholds.on, parameters.from_biases.on);
  printThreshold("C_OFF", -thresholds.off, parameters.from_biases.off);
  tools::printWarnings(parameters);
}

}  // namespace

int main(int argc, char** argv) {
  return tools::runTool("contrast_from_bias", [argc, argv] {
    Arguments arguments;
    if (parseArguments(argc, argv, arguments)) {
      run(arguments);
    }
    return tools::kDone;
  });
}
