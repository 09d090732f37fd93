// SPDX-License-Identifier: MIT
#include "cli/messages/remedy.hpp"

#include <fmt/format.h>

namespace mc::cli {

std::string with_remedy(std::string_view text, Remedy remedy) {
  switch (remedy) {
    case Remedy::none:
      break;
    case Remedy::more_memory:
      return fmt::format("--memory: {}; raise --memory or extract in parts with --region", text);
    case Remedy::smaller_region:
      return fmt::format("{}; extract it in parts with --region", text);
    case Remedy::close_border:
      return fmt::format("{}; --border closed caps it", text);
    case Remedy::choose_grid:
      return fmt::format("{}; choose with --grid", text);
    case Remedy::choose_iso:
      return fmt::format("{}; choose an --iso between them", text);
    case Remedy::keep_smaller:
      return fmt::format("--keep: {}; ask for a smaller size", text);
  }
  return std::string(text);
}

}  // namespace mc::cli
