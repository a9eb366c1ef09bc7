/// \file
/// What a tuning ends with: a file of parameters, and the command that deblurs with them.
#pragma once

#include <string>

#include "tools/tune/tune_arguments.hpp"
#include "tools/tune/tune_start.hpp"
#include "tuning/tuning_session.hpp"

namespace fast_edi::tune {

/// What is saved.
std::string configurationText(const TuningSession& session);

/// Writes the parameters, and says so, or why not: in the session's message, too.
/// \return whether they were written
bool save(const Arguments& arguments, TuningSession& session);

/// \param saved configuration of the file, empty if none was written
void printCommand(const Arguments& arguments, const Start& start, const TuningSession& session,
                  const std::string& saved);

}  // namespace fast_edi::tune
