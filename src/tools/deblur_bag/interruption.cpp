#include "tools/deblur_bag/interruption.hpp"

#include <csignal>

namespace fast_edi::deblur_bag {
namespace {

/// The only thing that a signal's handler may touch.
volatile std::sig_atomic_t interrupting_signal = 0;

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

}  // namespace fast_edi::deblur_bag
