// SPDX-License-Identifier: MIT
#include "cli/invocation.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "mc/base.hpp"

namespace mc::cli {

int show(Console& console, const Failure& failure) {
  console.end_stage();
  for (const std::string& line : failure.lines) console.error(line);
  return failure.status;
}

void print_out(std::string_view text) {
  errno = 0;
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0) {
    throw Error(ErrorKind::output, "<stdout>",
                std::string("cannot write: ") + std::strerror(errno));
  }
}

}  // namespace mc::cli
