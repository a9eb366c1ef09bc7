/// \file
/// Programs that a test runs beside itself.
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

namespace fast_edi {
namespace test {

class ChildProcess {
 public:
  /// Starts \p command, whose first word is looked up in PATH.
  explicit ChildProcess(std::vector<std::string> command);
  /// Interrupts it.
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// Waits for its end. \return the exit status, -1 when it did not exit by itself
  int wait();
  /// Sends \p signal, unless it has ended.
  void send(int signal);
  /// Interrupts it like Ctrl-C and waits.
  void interrupt();

 private:
  pid_t pid_ = -1;
};

}  // namespace test
}  // namespace fast_edi
