// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <stop_token>
#include <thread>

// Ends the program at once when asked to, and leaves no partial file behind.

namespace mc::cli {

/// Must be made before any other thread is: it blocks SIGINT, SIGTERM and SIGHUP in the caller,
/// whose threads inherit that, and one thread waits for them. When one comes, that thread asks
/// `stop` to stop, unlinks the partial files, and lets the signal end the process, whatever a
/// library is busy with. Signals that the parent had ignored (nohup) stay ignored.
/// SIGPIPE unlinks too and then ends the process without a word. SIGBUS does so unless it tells
/// that an input became shorter, which an InputWatch finds later.
class SignalThread {
 public:
  explicit SignalThread(std::stop_source& stop);
  ~SignalThread();
  SignalThread(const SignalThread&) = delete;
  SignalThread& operator=(const SignalThread&) = delete;

 private:
  std::atomic<bool> ended_{false};
  std::thread thread_;
};

}  // namespace mc::cli
