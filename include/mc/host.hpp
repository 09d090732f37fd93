// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

// What a program that hosts the library does about signals, SIGBUS and partial files. The library
// installs no handler and blocks no signal; a program that ignores this header works, but
//
// - a signal that ends it leaves partial files behind (NAME.partial-XXXX): call unlink_partials()
//   from a thread that waits for SIGINT, SIGTERM and SIGHUP (sigwait), or from a handler, then let
//   the signal end the process;
// - an input that another process truncates while it is mapped raises SIGBUS: install a handler
//   with SA_SIGINFO that calls recover_input(info->si_addr) and, where that returns false, lets the
//   signal end the process;
// - an input that changes while it is read would give a mesh of two states: convert() refuses that
//   by itself; a program that calls open_source() and run() keeps an InputWatch from before the
//   opening and calls refuse_changed() before the sink's finish();
// - a write to a closed pipe raises SIGPIPE, and one past a file-size limit SIGXFSZ: ignore them to
//   get an Error of kind output instead.

namespace mc {

/// Knows the files that its thread opens as inputs during its life. Watches of one thread nest: a
/// file belongs to the innermost.
class InputWatch {
 public:
  InputWatch();
  ~InputWatch();
  InputWatch(const InputWatch&) = delete;
  InputWatch& operator=(const InputWatch&) = delete;

  /// Refuses inputs that changed while they were open, or are open still: what was made of them is
  /// not to be kept. Errors   input: changed, or became shorter.
  void refuse_changed() const;

  struct State;

 private:
  std::unique_ptr<State> state_;
};

/// refuse_changed() of this thread's innermost watch; nothing where there is none.
void refuse_changed_inputs();

/// For a handler of SIGBUS, which reading a mapped file raises once the file has become shorter:
/// where `address` lies in an input, zeros take the place of the missing bytes, and
/// refuse_changed() will report it. Async-signal-safe. Returns whether the address lies in an
/// input.
bool recover_input(const void* address) noexcept;

/// Unlinks every partial file of this process, and puts back what several files that belong
/// together were about to replace. For a process that is about to end: a thread that then makes or
/// renames an output blocks until that end. Async-signal-safe enough for a signal thread: takes no
/// lock that a blocked writer has, and waits at most a tenth of a second for a blocked rename.
void unlink_partials() noexcept;

}  // namespace mc
