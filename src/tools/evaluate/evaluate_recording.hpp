/// \file
/// Methods compared on a recording.
#pragma once

#include "tools/evaluate/evaluate_arguments.hpp"

namespace fast_edi::evaluate {

/// \return the exit code
/// \throws std::runtime_error when no frame can be compared
int evaluateRecording(const Arguments& arguments);

}  // namespace fast_edi::evaluate
