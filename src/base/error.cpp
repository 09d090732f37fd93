// SPDX-License-Identifier: MIT
#include "mc/base.hpp"

namespace mc {

namespace {

std::string one_line(std::string_view place, std::string_view fault, std::string_view remedy) {
  std::string line;
  if (!place.empty()) {
    line.append(place).append(": ");
  }
  line.append(fault);
  if (!remedy.empty()) {
    line.append("; ").append(remedy);
  }
  return line;
}

class SilentProgress final : public Progress {
 public:
  void begin(std::string_view /*stage*/, std::uint64_t /*total*/,
             std::string_view /*unit*/) override {}
  void advance(std::uint64_t /*done*/) override {}
  void note(std::string_view /*text*/) override {}
  void warn(std::string_view /*text*/) override {}
};

}  // namespace

Error::Error(ErrorKind kind, std::string_view place, std::string_view fault,
             std::string_view remedy)
    : kind_(kind), lines_{one_line(place, fault, remedy)} {}

Error::Error(ErrorKind kind, std::string_view place, std::string_view fault, Remedy remedy)
    : kind_(kind), remedy_(remedy), lines_{one_line(place, fault, {})} {}

Error::Error(ErrorKind kind, std::vector<std::string> lines)
    : kind_(kind), lines_(std::move(lines)) {
  if (lines_.empty()) {
    lines_.emplace_back("unknown fault");
  }
}

Progress& silent_progress() {
  static SilentProgress silent;
  return silent;
}

}  // namespace mc
