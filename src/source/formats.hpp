// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>
#include <vector>

#include "mc/source.hpp"

// Finding a format's row. Rows of the library come before an embedder's, except those that are
// known by name only.

namespace mc::source {

/// By the first bytes of the first file. Null: no format says that they are its own.
[[nodiscard]] const SourceFormat* format_of_content(SourceInput& input, SourceFormats further);
/// By an extension in lower case without its dot. Null: it names none.
[[nodiscard]] const SourceFormat* format_of_extension(std::string_view extension,
                                                      SourceFormats further);
/// The format of samples without a header.
[[nodiscard]] const SourceFormat& headerless_format(SourceFormats further);

/// Names that SourceOptions::from may have, for messages.
[[nodiscard]] std::vector<std::string_view> readable_names(SourceFormats further);

/// Throws Error(input): this build has no library for `format`; names the package.
[[noreturn]] void refuse_absent(const SourceFormat& format, std::string_view place);

}  // namespace mc::source
