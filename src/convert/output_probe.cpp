// SPDX-License-Identifier: MIT
#include "convert/output_probe.hpp"

#include <sys/stat.h>

namespace mc::conversion {

bool can_be_probed(const std::string& output) {
  if (output == "-") return false;
  struct stat status {};
  return ::stat(output.c_str(), &status) != 0 || S_ISREG(status.st_mode);
}

}  // namespace mc::conversion
