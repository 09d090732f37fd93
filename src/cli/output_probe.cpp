// SPDX-License-Identifier: MIT
#include "cli/output_probe.hpp"

#include <sys/stat.h>

namespace mc::cli {

bool can_be_probed(const std::string& output) {
  if (output == "-") return false;
  struct stat status {};
  return ::stat(output.c_str(), &status) != 0 || S_ISREG(status.st_mode);
}

}  // namespace mc::cli
