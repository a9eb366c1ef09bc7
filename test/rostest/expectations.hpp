/// \file
/// What every output has to fulfil.
#pragma once

#include <vector>

#include "rostest/recording.hpp"

namespace fast_edi {
namespace test {

/// One output for each image of \p recording with its stamp (mid-exposure in, mid-exposure out),
/// frame_id, encoding and size, rows without padding, and a camera_info with the same header.
void expectOneOutputForEachFrame(const Recording& recording, const std::vector<Output>& outputs);

/// The same pixels as \p expected, and the same calibration.
void expectSameImages(const std::vector<Output>& outputs, const std::vector<Output>& expected);

/// How many outputs differ from their input.
int countChanged(const Recording& recording, const std::vector<Output>& outputs);

}  // namespace test
}  // namespace fast_edi
