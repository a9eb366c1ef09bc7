#include "support/recordings.hpp"

#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <stdexcept>

namespace fast_edi::testing {

std::vector<NamedRecording> recordings() {
  const std::string root = FAST_EDI_SOURCE_DIR;
  std::vector<NamedRecording> found = {{"demo",
                                        root + "/bags/demo.bag",
                                        "",
                                        30,
                                        {"/dvs/events", "/dvs/image_raw", "/dvs/exposure",
                                         "/dvs/camera_info", "/dvs/ground_truth/image_raw"}}};
  const char* variable = std::getenv("FAST_EDI_RECORDINGS");
  if (variable == nullptr || *variable == '\0') {
    std::cout << "FAST_EDI_RECORDINGS is not set: the package's own recordings alone\n";
  } else {
    const std::string folder = variable;
    found.push_back({"davis346_cups",
                     folder + "/davis346_cups.bag",
                     "contrast_threshold_on:=0.36 contrast_threshold_off:=0.36",
                     10,
                     {"/dvs/events", "/dvs/image_raw", "/dvs/exposure"}});
    // It does not say how long it was exposed.
    found.push_back({"davis240c_slider",
                     folder + "/davis240c_slider.bag",
                     "exposure_time_us:=5000",
                     5,
                     {"/dvs/events", "/dvs/image_raw"}});
  }
  for (const NamedRecording& recording : found) {
    if (!std::filesystem::exists(recording.path)) {
      throw std::runtime_error(recording.path + " is missing");
    }
  }
  return found;
}

}  // namespace fast_edi::testing
