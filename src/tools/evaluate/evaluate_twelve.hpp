/// \file
/// Methods compared on the twelve simulated sequences.
#pragma once

#include "fast_edi/parameters/parameters.hpp"
#include "tools/evaluate/evaluate_arguments.hpp"

namespace fast_edi::evaluate {

/// \return the exit code
int evaluateTwelve(const Arguments& arguments, const DeblurParameters& parameters);

}  // namespace fast_edi::evaluate
