// SPDX-License-Identifier: MIT
#include "cli/runner.hpp"

int main(int argc, char** argv) {
  return mc::cli::run_program({argv + 1, argv + (argc > 0 ? argc : 1)});
}
