// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "cli/arguments/resolve.hpp"
#include "mc/base.hpp"

// The program's voice on stderr: notes, warnings, errors, and a progress bar that keeps out of
// their way. No colours and no escape sequences, so NO_COLOR has nothing to turn off.

namespace mc::cli {

class Console final : public Progress {
 public:
  /// Nothing is drawn until configure(); notes, warnings and errors are.
  Console();

  void configure(const CommonOptions& options);

  void begin(std::string_view stage, std::uint64_t total, std::string_view unit) override;
  void advance(std::uint64_t done) override;
  void note(std::string_view text) override;
  void note_remedy(std::string_view text, Remedy remedy) override;
  void warn(std::string_view text) override;
  /// What only -v shows.
  void detail(std::string_view text) override;

  void error(std::string_view text);
  /// Whether a summary is wanted at the end: on a terminal, without -q.
  [[nodiscard]] bool shows_summary();
  /// Removes the progress bar.
  void end_stage() override;

  /// For one of several jobs at once: what it says is kept, until take_lines() hands it out.
  void keep_lines();
  std::vector<std::string> take_lines();
  /// Lines that another console has kept.
  void print_lines(const std::vector<std::string>& lines);

  /// Warnings since the last call, oldest first.
  std::vector<std::string> take_warnings();

 private:
  using Clock = std::chrono::steady_clock;

  void print_line(std::string_view text);
  void clear_bar();
  void draw();
  void draw_bar(std::uint64_t done, double seconds);
  void draw_json(std::uint64_t done, double seconds);

  std::mutex mutex_;  // guards all but the atomics
  bool quiet_ = false;
  bool verbose_ = false;
  bool keeps_lines_ = false;
  std::vector<std::string> lines_;  // kept
  bool draws_bar_ = false;
  bool draws_json_ = false;
  std::size_t bar_width_ = 0;  // of what is on the line now
  std::string stage_, unit_;
  std::uint64_t total_ = 0;
  Clock::time_point began_;
  std::atomic<std::uint64_t> done_{0};
  std::atomic<std::int64_t> next_draw_ms_{0};  // since began_
  std::vector<std::string> warnings_;
};

}  // namespace mc::cli
