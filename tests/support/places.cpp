// SPDX-License-Identifier: MIT
#include "support/places.hpp"

#include <cstdlib>

namespace mc::test {

std::string source_file(const std::string& name) { return MC_SOURCE_DIR "/" + name; }

std::string shared_volume(const std::string& name) {
  const char* folder = std::getenv("MC_TEST_VOLUMES");
  return std::string(folder != nullptr ? folder : MC_DEFAULT_TEST_VOLUMES) + "/" + name;
}

}  // namespace mc::test
