#include "silvasim/base/progress.h"

#include <unistd.h>

#include <csignal>

#include "silvasim/base/error.h"
#include "silvasim/base/file.h"

namespace silvasim::base {

namespace {

volatile std::sig_atomic_t interrupt_count = 0;

// Only what is safe in a signal handler: count, and on the second signal unlink half-written files and leave.
extern "C" void on_interrupt(int) {
  interrupt_count = interrupt_count + 1;
  if (interrupt_count > 1) {
    remove_unfinished_files_from_signal_handler();
    _exit(130);
  }
}

}  // namespace

bool interrupted() { return interrupt_count > 0; }

void install_interrupt_handler() {
  struct sigaction action {};
  action.sa_handler = on_interrupt;
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

void report(const Progress& progress, std::string_view stage, double done) {
  if (interrupted()) throw Cancelled();
  if (progress && !progress(stage, done)) throw Cancelled();
}

}  // namespace silvasim::base
