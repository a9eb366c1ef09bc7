/// \file
/// Methods other than those that `evaluate` always compares.
#pragma once

#include <string>
#include <vector>

#include "evaluation/other_method.hpp"
#include "tools/evaluate/evaluate_arguments.hpp"

namespace fast_edi::evaluate {

/// What --dark-channel, --network and --column ask for. Adds to \p incomplete what is wrong with
/// the recordings.
/// \throws std::runtime_error when one of them cannot be used
OtherMethods otherMethods(const Arguments& arguments, std::vector<std::string>& incomplete);

}  // namespace fast_edi::evaluate
