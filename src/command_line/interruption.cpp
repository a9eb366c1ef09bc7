#include "interruption.hpp"

#include <atomic>
#include <csignal>

namespace fast_edi::tools {
namespace {

/// Set by a signal's handler, which may touch nothing that locks; read by other threads.
std::atomic<int> interrupting_signal{0};
static_assert(std::atomic<int>::is_always_lock_free);

extern "C" void noteSignal(int signal) {
  interrupting_signal = signal;
}

}  // namespace

void handleSignals() {
  struct sigaction stop = {};
  stop.sa_handler = noteSignal;
  stop.sa_flags = SA_RESETHAND;  // a second one ends the program at once
  sigaction(SIGINT, &stop, nullptr);
  sigaction(SIGTERM, &stop, nullptr);
  std::signal(SIGXFSZ, SIG_IGN);
}

int interruptingSignal() {
  return interrupting_signal;
}

}  // namespace fast_edi::tools
