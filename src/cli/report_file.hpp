// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "sink/output_file.hpp"

// Where `--report` goes: a file that appears whole at the end, or stdout line by line.

namespace mc::cli {

class ReportFile {
 public:
  /// Without a path nothing is written. An existing file is replaced: a report is made anew by
  /// every run. Errors   output: the file cannot be made; found here, before the work.
  explicit ReportFile(const std::optional<std::string>& path);

  void add_line(std::string line);
  /// Puts the file under its name.
  void finish();

 private:
  bool to_stdout_ = false;
  std::unique_ptr<sink::OutputFile> file_;
};

}  // namespace mc::cli
