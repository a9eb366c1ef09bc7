/// \file
/// Ctrl-C and SIGTERM end a run in order rather than at once.
#pragma once

namespace fast_edi::tools {

/// From now on, the first SIGINT or SIGTERM is only noted; a second one ends the program. A file
/// larger than the process may write becomes an error that can be reported.
void handleSignals();

/// The signal that asked to stop, 0 before.
int interruptingSignal();

}  // namespace fast_edi::tools
