// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>

#include "sink/vdb/module/vdb_writer.hpp"

namespace mc::sink {

/// A writer from the module, which is loaded first where it is not yet. `place` is the output in
/// messages. The module is looked for in the folders that the program's RUNPATH names, then where
/// the system looks for libraries.
/// Errors   output: the module, or OpenVDB's library, is not there.
/// Threads  may be called from several threads at once.
std::unique_ptr<VdbWriter> open_vdb_writer(const std::string& place);

}  // namespace mc::sink
