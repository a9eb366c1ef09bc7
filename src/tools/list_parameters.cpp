/// \file
/// `list_parameters`: every key of a configuration, its range, unit and default.

#include <exception>
#include <iostream>

#include <boost/program_options.hpp>

#include "fast_edi/config/parameter_table.hpp"
#include "fast_edi/config/tag_detector_parameters.hpp"

namespace {

namespace po = boost::program_options;

constexpr int kDone = 0;
constexpr int kBadUsage = 2;

void printText(const std::vector<fast_edi::ParameterDescription>& descriptions) {
  for (const fast_edi::ParameterDescription& key : descriptions) {
    std::cout << key.name << " (" << key.type;
    if (!key.range.empty()) {
      std::cout << ", " << key.range;
    }
    if (!key.unit.empty()) {
      std::cout << " [" << key.unit << "]";
    }
    std::cout << "; default: " << key.default_value << (key.live ? "; live" : "") << ")\n    "
              << key.doc << "\n";
  }
}

void print(bool markdown) {
  if (markdown) {
    std::cout << fast_edi::markdownTable(fast_edi::parameterDescriptions()) << "\n"
              << fast_edi::markdownTable(fast_edi::biasDescriptions()) << "\n"
              << fast_edi::markdownTable(fast_edi::tagDetectorDescriptions());
    return;
  }
  printText(fast_edi::parameterDescriptions());
  std::cout << "\nIn the map biases:\n";
  printText(fast_edi::biasDescriptions());
  std::cout << "\nOf the tag detector:\n";
  printText(fast_edi::tagDetectorDescriptions());
}

}  // namespace

int main(int argc, char** argv) {
  try {
    po::options_description options("Options");
    bool markdown = false;
    options.add_options()("help,h", "print this")("markdown", po::bool_switch(&markdown),
                                                  "as the tables of the documents");
    po::variables_map values;
    po::store(po::parse_command_line(argc, argv, options), values);
    po::notify(values);
    if (values.count("help") > 0) {
      std::cout
          << "Usage: list_parameters [--markdown]\n\n"
             "Lists the parameters of the nodelet and of the YAML files in cfg/. Those called\n"
             "live can be changed while frames are deblurred.\n\n"
          << options << "\nExit code: 0 done; 2 wrong arguments.\n";
      return kDone;
    }
    print(markdown);
    return kDone;
  } catch (const po::error& error) {
    std::cerr << "list_parameters: " << error.what() << "\n";
    return kBadUsage;
  }
}
