// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>
#include <stop_token>
#include <string>

#include "sink/output_file.hpp"

// Where `--report` goes: a file that appears whole at the end, or stdout line by line.

namespace mc::cli {

class ReportFile {
 public:
  /// Without a path nothing is written. An existing file is replaced: a report is made anew by
  /// every run. Errors   output: the file cannot be made; found here, before the work.
  ReportFile(const std::optional<std::string>& path, std::stop_token stop);

  void add_line(std::string line);
  /// Puts the file under its name. Where the run is asked to stop, which may have cut it short
  /// before its first line, there is no file, and an old one stays.
  void finish();

 private:
  std::stop_token stop_;
  bool to_stdout_ = false;
  std::unique_ptr<sink::OutputFile> file_;
};

}  // namespace mc::cli
