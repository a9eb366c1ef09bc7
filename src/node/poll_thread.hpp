/// \file
/// roscpp's thread for connections.
#pragma once

namespace fast_edi {

/// Returns once roscpp's thread for connections has ended what it is doing now, or is gone. When a
/// service has ended, that thread may still be about to queue a request for it
/// (ServicePublication::processRequest() takes no lock): call this before the callback queue goes.
/// \pre not in that thread, nor with a lock held that a callback in it may want
void waitForPollThread();

}  // namespace fast_edi
