// SPDX-License-Identifier: MIT
#include "cli/signals.hpp"

#include <csignal>

#include "mc/host.hpp"

namespace mc::cli {

namespace {

/// Signals that end the program, but for those its parent told it to ignore.
sigset_t ending_signals() {
  sigset_t set;
  sigemptyset(&set);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction was {};
    sigaction(signal, nullptr, &was);
    if (was.sa_handler != SIG_IGN) sigaddset(&set, signal);
  }
  // Wakes the waiting thread when the program ends by itself.
  sigaddset(&set, SIGUSR2);
  return set;
}

void die_by(int signal) {
  unlink_partials();
  std::signal(signal, SIG_DFL);
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, signal);
  pthread_sigmask(SIG_UNBLOCK, &set, nullptr);
  ::raise(signal);
}

void on_bus_error(int signal, siginfo_t* info, void* /*context*/) {
  if (!recover_input(info->si_addr)) die_by(signal);
}

/// In every thread: the one that reads gets the signal.
void recover_inputs() {
  struct sigaction action {};
  action.sa_sigaction = on_bus_error;
  action.sa_flags = SA_SIGINFO;
  sigaction(SIGBUS, &action, nullptr);
}

}  // namespace

SignalThread::SignalThread(std::stop_source& stop) {
  const sigset_t set = ending_signals();
  pthread_sigmask(SIG_BLOCK, &set, nullptr);
  // SIGPIPE goes to the thread that wrote, so a handler has to take it.
  std::signal(SIGPIPE, die_by);
  std::signal(SIGXFSZ, SIG_IGN);  // a file that may not grow fails the write, which can be told
  recover_inputs();
  thread_ = std::thread([this, set, &stop] {
    for (;;) {
      int signal = 0;
      if (sigwait(&set, &signal) != 0) continue;
      if (ended_) return;
      if (signal == SIGUSR2) continue;
      stop.request_stop();
      die_by(signal);
    }
  });
}

SignalThread::~SignalThread() {
  ended_ = true;
  pthread_kill(thread_.native_handle(), SIGUSR2);
  thread_.join();
}

}  // namespace mc::cli
