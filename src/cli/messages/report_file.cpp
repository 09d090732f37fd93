// SPDX-License-Identifier: MIT
#include "cli/messages/report_file.hpp"

#include <utility>

#include "cli/invocation.hpp"

namespace mc::cli {

ReportFile::ReportFile(const std::optional<std::string>& path, std::stop_token stop)
    : stop_(std::move(stop)) {
  if (!path) return;
  to_stdout_ = *path == "-";
  if (!to_stdout_) {
    file_ = std::make_unique<sink::OutputFile>(
        *path, sink::OutputFile::Options{.force = true, .binary = false});
  }
}

void ReportFile::add_line(std::string line) {
  line += '\n';
  if (to_stdout_) print_out(line);
  if (file_) file_->append(std::string_view(line));
}

void ReportFile::finish() {
  if (file_ && !stop_.stop_requested()) file_->commit();
}

}  // namespace mc::cli
