/// \file
/// Variants of the parameters compared on a set of simulated sequences.
#pragma once

#include "fast_edi/parameters/parameters.hpp"
#include "sequences/sequence_sets.hpp"
#include "tools/evaluate/evaluate_arguments.hpp"

namespace fast_edi::evaluate {

/// \return the exit code
/// \throws boost::program_options::error for a variant that is none
int evaluateSet(const Arguments& arguments, SequenceSet set, const DeblurParameters& parameters);

}  // namespace fast_edi::evaluate
