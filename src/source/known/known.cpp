// SPDX-License-Identifier: MIT
#include "source/known/known.hpp"

#include "source/magic.hpp"
#include "source/text.hpp"

namespace mc::source {

Recognition recognise_dicom(std::string_view head) {
  constexpr std::size_t kPreambleBytes = 128;
  return recognised(has_magic(head, "DICM", kPreambleBytes));
}

Recognition recognise_nifti(std::string_view head) {
  constexpr std::size_t kMagicAt = 344;
  return recognised(has_magic(head, {"n+1\0", 4}, kMagicAt) ||
                    has_magic(head, {"ni1\0", 4}, kMagicAt));
}

Recognition recognise_tiff(std::string_view head) {
  return recognised(has_magic(head, {"II*\0", 4}) || has_magic(head, {"MM\0*", 4}) ||
                    has_magic(head, {"II+\0", 4}) || has_magic(head, {"MM\0+", 4}));
}

Recognition recognise_meta(std::string_view head) {
  const std::string_view line = head.substr(0, head.find('\n')).substr(0, 80);
  const std::string_view key = trimmed(line.substr(0, line.find('=')));
  return recognised(line.find('=') != std::string_view::npos &&
                    (key == "ObjectType" || key == "NDims" || key == "Comment"));
}

}  // namespace mc::source
