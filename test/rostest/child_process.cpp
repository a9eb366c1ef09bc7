#include "rostest/child_process.hpp"

#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <stdexcept>

namespace fast_edi {
namespace test {
namespace {

constexpr int kNotFound = 127;  // as shells have it

}  // namespace

ChildProcess::ChildProcess(std::vector<std::string> command) {
  std::vector<char*> argv;
  for (std::string& word : command) {
    argv.push_back(word.data());
  }
  argv.push_back(nullptr);
  pid_ = fork();
  if (pid_ == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);  // a test that crashes leaves nothing behind
    signal(SIGINT, SIG_DFL);           // a shell that runs the tests in the background ignores it
    execvp(argv[0], argv.data());
    _exit(kNotFound);
  }
  if (pid_ < 0) {
    throw std::runtime_error("no process for " + command.front());
  }
}

ChildProcess::~ChildProcess() {
  interrupt();
}

int ChildProcess::wait() {
  int status = 0;
  if (pid_ < 0 || waitpid(pid_, &status, 0) != pid_) {
    return -1;
  }
  pid_ = -1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

void ChildProcess::send(int signal) {
  if (pid_ > 0) {
    kill(pid_, signal);
  }
}

void ChildProcess::interrupt() {
  send(SIGINT);
  wait();
}

}  // namespace test
}  // namespace fast_edi
