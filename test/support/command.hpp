/// \file
/// Runs a command as a user would and keeps what it printed.
#pragma once

#include <string>

namespace fast_edi::testing {

struct CommandResult {
  int exit_code = -1;  ///< -1 when a signal ended it
  std::string output;  ///< standard output and standard error together
};

/// \param command a line for /bin/sh
/// \throws std::runtime_error when no shell could be started
CommandResult runCommand(const std::string& command);

}  // namespace fast_edi::testing
