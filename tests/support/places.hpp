// SPDX-License-Identifier: MIT
#pragma once

#include <string>

// Where tests find what is not theirs. Only places.cpp is compiled with this machine's folders, so
// that a compiler cache serves every checkout.

namespace mc::test {

/// A file of the source tree.
std::string source_file(const std::string& name);

/// Where the volumes of third parties are; a test that wants one skips itself when it is not there.
std::string shared_volume(const std::string& name);

}  // namespace mc::test
