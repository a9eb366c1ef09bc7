/// \file
#pragma once

#include <chrono>

namespace fast_edi {

/// Ends waiting in another thread, for good.
class Interrupt {
 public:
  /// \throws std::system_error when the process has no descriptor left
  Interrupt();
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  /// From any thread; waits for none.
  void raise();
  /// Waits until \p descriptor has one of poll()'s \p events, or an error.
  enum class Wait { kReady, kTimeout, kInterrupted };
  Wait waitFor(int descriptor, short events, std::chrono::milliseconds timeout) const;
  /// Waits until raised, for \p duration at most. \return whether it was
  bool waitFor(std::chrono::milliseconds duration) const;

 private:
  int descriptor_;
};

}  // namespace fast_edi
