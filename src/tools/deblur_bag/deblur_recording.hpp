/// \file
/// One recording from beginning to end.
#pragma once

#include "fast_edi/bags/bag_deblurrer.hpp"
#include "tools/deblur_bag/deblur_bag_arguments.hpp"

namespace fast_edi::deblur_bag {

/// What became of it.
struct RecordingOutcome {
  BagDeblurReport report;
  int exit_code = 0;
};

/// Deblurs the recording whose parts are \p arguments.inputs, writes what was asked for, and prints
/// what was done. Of one of many (`output_folder`), nothing is written when it is interrupted.
/// \throws std::runtime_error when it could not be done
RecordingOutcome deblurRecording(const Arguments& arguments);

}  // namespace fast_edi::deblur_bag
