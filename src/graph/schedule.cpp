// SPDX-License-Identifier: MIT
#include "graph/schedule.hpp"

#include <algorithm>
#include <limits>
#include <utility>

// What is done to a program's code as a whole, after it was emitted.

namespace mc::graph {

namespace {

std::span<const Value> inputs_of(const Instruction& instruction) {
  return std::span(instruction.in).first(instruction.n_in);
}

/// Which values the result needs.
std::vector<bool> needed(const std::vector<Instruction>& code, Value result) {
  std::vector<bool> live(code.size(), false);
  live[result] = true;
  for (std::size_t n = code.size(); n-- > 0;) {
    for (const Value input : inputs_of(code[n])) {
      live[input] = live[input] || live[n];
    }
  }
  return live;
}

/// Which values one of two coordinates changes.
std::vector<bool> varies_with(const std::vector<Instruction>& code, Op one, Op other) {
  std::vector<bool> varies(code.size(), false);
  for (std::size_t n = 0; n < code.size(); ++n) {
    const auto inputs = inputs_of(code[n]);
    varies[n] = code[n].op == one || code[n].op == other ||
                std::any_of(inputs.begin(), inputs.end(), [&](Value v) { return varies[v]; });
  }
  return varies;
}

/// The live instructions, those that do not change along y first.
void take_in_order(Program& program, const std::vector<Instruction>& code, Value result) {
  const std::vector<bool> live = needed(code, result);
  const std::vector<bool> deep = varies_with(code, Op::y, Op::y);
  std::vector<Value> moved(code.size(), 0);
  for (const bool pass : {false, true}) {
    for (std::size_t n = 0; n < code.size(); ++n) {
      if (!live[n] || deep[n] != pass) continue;
      Instruction taken = code[n];
      for (std::size_t i = 0; i < taken.n_in; ++i) taken.in[i] = moved[taken.in[i]];
      taken.out = static_cast<Value>(program.code.size());
      moved[n] = taken.out;
      program.code.push_back(taken);
    }
    if (!pass) program.n_flat = program.code.size();
  }
  program.result = moved[result];
}

constexpr std::size_t kForever = std::numeric_limits<std::size_t>::max();

/// The instruction after which a value is not used any more. What the flat part leaves for the
/// other is wanted for every row.
std::vector<std::size_t> last_uses(const Program& program) {
  std::vector<std::size_t> last(program.code.size(), 0);
  for (std::size_t n = 0; n < program.code.size(); ++n) {
    for (const Value input : inputs_of(program.code[n])) {
      last[input] = n >= program.n_flat && input < program.n_flat ? kForever : n;
    }
  }
  last[program.result] = kForever;
  return last;
}

/// Gives values registers. One is free again after its value's last use, but never within that
/// instruction: rows of one instruction do not overlap.
void give_homes(Program& program) {
  const std::vector<std::size_t> last = last_uses(program);
  std::vector<std::uint32_t> free;
  std::vector<bool> released(program.code.size(), false);
  program.homes.assign(program.code.size(), 0);
  for (std::size_t n = 0; n < program.code.size(); ++n) {
    if (free.empty()) free.push_back(program.n_registers++);
    program.homes[n] = free.back();
    free.pop_back();
    for (const Value input : inputs_of(program.code[n])) {
      if (last[input] == n && !released[input]) {
        free.push_back(program.homes[input]);
        released[input] = true;
      }
    }
  }
}

}  // namespace

Program schedule(const std::vector<Instruction>& code, Value result) {
  Program program;
  take_in_order(program, code, result);
  const std::vector<bool> wide = varies_with(program.code, Op::x, Op::z);
  program.uniform.assign(wide.size(), false);
  std::transform(wide.begin(), wide.end(), program.uniform.begin(), [](bool w) { return !w; });
  give_homes(program);
  return program;
}

}  // namespace mc::graph
