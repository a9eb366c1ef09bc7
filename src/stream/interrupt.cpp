#include "stream/interrupt.hpp"

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <system_error>
#include <thread>

namespace fast_edi {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

}  // namespace

Interrupt::Interrupt() : descriptor_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  if (descriptor_ < 0) {
    throw std::system_error(errno, std::generic_category(), "eventfd");
  }
}

Interrupt::~Interrupt() {
  ::close(descriptor_);
}

void Interrupt::raise() {
  const std::uint64_t one = 1;
  // Fails only when it was raised 2^64 - 2 times.
  const ssize_t written = ::write(descriptor_, &one, sizeof(one));
  static_cast<void>(written);
}

Interrupt::Wait Interrupt::waitFor(int descriptor, short events, milliseconds timeout) const {
  std::array<pollfd, 2> waited = {{{descriptor_, POLLIN, 0}, {descriptor, events, 0}}};
  const steady_clock::time_point end = steady_clock::now() + timeout;
  for (;;) {
    const auto left = std::chrono::duration_cast<milliseconds>(end - steady_clock::now());
    const int ready = ::poll(waited.data(), waited.size(),
                             static_cast<int>(std::max(milliseconds(0), left).count()));
    if (waited[0].revents != 0) {
      return Wait::kInterrupted;
    }
    if (ready > 0) {
      return Wait::kReady;
    }
    if (ready == 0) {
      return Wait::kTimeout;
    }
    if (errno != EINTR) {
      // The kernel is out of memory: it may have some later. Nobody is told by an exception, since
      // the threads that wait here must go on.
      std::this_thread::sleep_for(milliseconds(1));
      if (steady_clock::now() >= end) {
        return Wait::kTimeout;
      }
    }
    waited[0].revents = waited[1].revents = 0;
  }
}

bool Interrupt::waitFor(milliseconds duration) const {
  return waitFor(-1, 0, duration) == Wait::kInterrupted;
}

}  // namespace fast_edi
