// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace mc::conversion {

/// Whether opening the output and dropping it again finds out, unseen, that it can be written: so
/// for what appears by its name in the end; devices and FIFOs feel it at their other end.
bool can_be_probed(const std::string& output);

}  // namespace mc::conversion
