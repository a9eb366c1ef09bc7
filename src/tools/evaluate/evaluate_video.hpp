/// \file
/// The high-rate video against the truth.
#pragma once

#include "fast_edi/parameters/parameters.hpp"
#include "tools/evaluate/evaluate_arguments.hpp"

namespace fast_edi::evaluate {

/// Prints its table.
/// \return the exit code
int evaluateVideo(const Arguments& arguments, const DeblurParameters& parameters);

}  // namespace fast_edi::evaluate
