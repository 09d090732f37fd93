// SPDX-License-Identifier: MIT
#include "cli/arguments/file_list.hpp"

#include <cerrno>
#include <fstream>
#include <iostream>
#include <system_error>

#include "mc/base.hpp"

namespace mc::cli {

void append_listed(const std::string& path, bool end_in_nul, std::vector<std::string>& names) {
  const bool is_stdin = path == "-";
  const std::string place = is_stdin ? "<stdin>" : path;
  std::ifstream file;
  errno = 0;
  if (!is_stdin) file.open(path, std::ios::binary);
  std::istream& in = is_stdin ? std::cin : file;
  const std::size_t before = names.size();
  for (std::string name; std::getline(in, name, end_in_nul ? '\0' : '\n');) {
    if (!end_in_nul && name.find('\0') != std::string::npos) {
      throw Error(ErrorKind::usage, place, "names that end in NUL, but lines were expected",
                  "add -0");
    }
    if (!name.empty()) names.push_back(name);
  }
  if (!in.eof() || in.bad()) {
    throw Error(ErrorKind::input, place,
                "cannot read: " + std::generic_category().message(errno != 0 ? errno : EIO));
  }
  if (names.size() == before) {
    throw Error(ErrorKind::usage, place, "names no file: expected the inputs of the batch");
  }
}

}  // namespace mc::cli
