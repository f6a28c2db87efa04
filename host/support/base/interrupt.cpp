#include "base/interrupt.hpp"

#include <csignal>
#include <initializer_list>

namespace dolp {
namespace {

volatile std::sig_atomic_t is_interrupted = 0;  // a signal handler may change variables of this type

}  // namespace

void watch_for_interrupts() {
  struct sigaction action {};  // no SA_RESTART, so a signal ends waiting system calls
  action.sa_handler = [](int number) {
    if (is_interrupted) {
      std::signal(number, SIG_DFL);
      std::raise(number);
    }
    is_interrupted = 1;
  };
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction before {};
    sigaction(signal, nullptr, &before);
    if (before.sa_handler != SIG_IGN) sigaction(signal, &action, nullptr);
  }
}

bool interrupted() { return is_interrupted != 0; }

}  // namespace dolp
