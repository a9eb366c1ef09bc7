/// \file
/// `list_parameters`: every key of a configuration, its range, unit and default.

#include <iostream>

#include <boost/program_options.hpp>

#include "command_line.hpp"
#include "fast_edi/config/dv_stream_parameters.hpp"
#include "fast_edi/config/parameter_table.hpp"
#include "fast_edi/config/tag_detector_parameters.hpp"

namespace {

namespace po = boost::program_options;

namespace tools = fast_edi::tools;

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
              << fast_edi::markdownTable(fast_edi::tagDetectorDescriptions()) << "\n"
              << fast_edi::markdownTable(fast_edi::dvStreamDescriptions());
    return;
  }
  printText(fast_edi::parameterDescriptions());
  std::cout << "\nIn the map biases:\n";
  printText(fast_edi::biasDescriptions());
  std::cout << "\nOf the tag detector:\n";
  printText(fast_edi::tagDetectorDescriptions());
  std::cout << "\nOf the streams of DV:\n";
  printText(fast_edi::dvStreamDescriptions());
}

}  // namespace

int main(int argc, char** argv) {
  return tools::runTool("list_parameters", [argc, argv] {
    po::options_description options("Options");
    bool markdown = false;
    options.add_options()("help,h", "print this")("markdown", po::bool_switch(&markdown),
                                                  "as the tables of the documents");
    tools::HelpText text{
        "Usage: list_parameters [--markdown]\n\n"
        "Lists the parameters of the nodelet and of the YAML files in cfg/. Those called\n"
        "live can be changed while frames are deblurred.\n",
        "0 done; 1 wrong arguments."};
    text.needs_arguments = false;
    auto values = tools::readCommandLine(argc, argv, options, text, nullptr);
    if (values) {
      po::notify(*values);
      print(markdown);
    }
    return tools::kDone;
  });
}
