/// \file
/// Many recordings, one after the other, each into a bag of its own.
#pragma once

#include <string>
#include <vector>

#include "tools/deblur_bag/deblur_bag_arguments.hpp"

namespace fast_edi::deblur_bag {

/// FOLDER/NAME.bag of each recording, NAME being that of its file without the ending, or of its
/// folder.
/// \throws boost::program_options::error when two would have the same, or a recording has no name
std::vector<std::string> outputsOf(const std::vector<std::string>& recordings,
                                   const std::string& folder);

/// Deblurs each of \p arguments.inputs into \p arguments.output_folder, which is made where it is
/// missing. One that fails does not end the run; an interruption does.
/// \return the exit code: that of an interruption, else the worst of all
int deblurRecordings(const Arguments& arguments);

}  // namespace fast_edi::deblur_bag
