// SPDX-License-Identifier: MIT
#pragma once

#include "source/script/context.hpp"

namespace mc::source {

/// Reads a script's header into `context`, which then refers to the document. `keys` are the
/// document's; "edits" is left to the caller.
void read_header(const JsonDocument& document, ObjectReader& keys, ScriptContext& context);

/// The folder that a script's paths are relative to, as a document's path for SpecFiles.
[[nodiscard]] std::string base_of(const JsonValue& root, const std::string& place);

}  // namespace mc::source
