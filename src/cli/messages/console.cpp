// SPDX-License-Identifier: MIT
#include "cli/messages/console.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <utility>

#include "cli/messages/remedy.hpp"

// Progress is drawn ten times a second at most, by whichever thread comes past first.

namespace mc::cli {

namespace {

constexpr std::int64_t kDrawEvery_ms = 100;

/// A bar makes sense where lines can be overwritten.
bool stderr_is_screen() {
  const char* term = std::getenv("TERM");
  return isatty(STDERR_FILENO) == 1 && (term == nullptr || std::string_view(term) != "dumb");
}

/// Columns of the terminal, less one: what fills a whole line wraps.
std::size_t screen_width() {
  winsize size{};
  const bool known = ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 1;
  return known ? size.ws_col - 1U : 79U;
}

std::string amount_text(double amount) {
  static constexpr std::string_view kPrefixes[] = {"", " k", " M", " G", " T"};
  std::size_t n = 0;
  for (; amount >= 1000 && n + 1 < std::size(kPrefixes); ++n) amount /= 1000;
  return n == 0 ? fmt::format("{:.0f} ", amount) : fmt::format("{:.1f}{}", amount, kPrefixes[n]);
}

std::string duration_text(double seconds) {
  const auto whole = static_cast<std::int64_t>(std::min(std::ceil(seconds), 359999.0));
  if (whole >= 3600) {
    return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
  }
  return fmt::format("{}:{:02}", whole / 60, whole % 60);
}

}  // namespace

Console::Console() : began_(Clock::now()) {}

void Console::configure(const CommonOptions& options) {
  const std::lock_guard lock(mutex_);
  quiet_ = options.quiet;
  verbose_ = options.verbose;
  draws_json_ = options.progress == ProgressMode::json;
  draws_bar_ = options.progress == ProgressMode::always ||
               (options.progress == ProgressMode::automatic && !quiet_ && stderr_is_screen());
}

void Console::begin(std::string_view stage, std::uint64_t total, std::string_view unit) {
  const std::lock_guard lock(mutex_);
  clear_bar();
  stage_ = stage;
  unit_ = unit;
  total_ = total;
  began_ = Clock::now();
  done_ = 0;
  next_draw_ms_ = kDrawEvery_ms;
}

void Console::advance(std::uint64_t done) {
  done_ += done;
  if (!draws_bar_ && !draws_json_) return;
  const auto now_ms =
      std::chrono::duration_cast<std::chrono::milliseconds>(Clock::now() - began_).count();
  std::int64_t due_ms = next_draw_ms_;
  if (now_ms < due_ms || !next_draw_ms_.compare_exchange_strong(due_ms, now_ms + kDrawEvery_ms)) {
    return;
  }
  const std::lock_guard lock(mutex_);
  draw();
}

void Console::end_stage() {
  const std::lock_guard lock(mutex_);
  if (draws_json_ && !stage_.empty()) draw();
  clear_bar();
  stage_.clear();
}

void Console::note(std::string_view text) {
  const std::lock_guard lock(mutex_);
  if (!quiet_) print_line(fmt::format("mc: {}", text));
}

void Console::note_remedy(std::string_view text, Remedy remedy) { note(with_remedy(text, remedy)); }

void Console::warn(std::string_view text) {
  const std::lock_guard lock(mutex_);
  warnings_.emplace_back(text);
  print_line(fmt::format("mc: warning: {}", text));
}

void Console::detail(std::string_view text) {
  const std::lock_guard lock(mutex_);
  if (verbose_) print_line(fmt::format("mc: {}", text));
}

bool Console::shows_summary() {
  const std::lock_guard lock(mutex_);
  return !quiet_ && !keeps_lines_ && isatty(STDERR_FILENO) == 1;
}

void Console::error(std::string_view text) {
  const std::lock_guard lock(mutex_);
  print_line(fmt::format("mc: error: {}", text));
}

std::vector<std::string> Console::take_warnings() {
  const std::lock_guard lock(mutex_);
  return std::exchange(warnings_, {});
}

void Console::keep_lines() {
  const std::lock_guard lock(mutex_);
  keeps_lines_ = true;
  draws_bar_ = draws_json_ = false;
}

std::vector<std::string> Console::take_lines() {
  const std::lock_guard lock(mutex_);
  return std::exchange(lines_, {});
}

void Console::print_lines(const std::vector<std::string>& lines) {
  const std::lock_guard lock(mutex_);
  for (const std::string& line : lines) print_line(line);
}

void Console::print_line(std::string_view text) {
  if (keeps_lines_) {
    lines_.emplace_back(text);
    return;
  }
  clear_bar();
  // One write a line, so that lines of several processes do not mix.
  std::string line(text);
  std::replace(line.begin(), line.end(), '\n', ' ');
  line += '\n';
  std::fwrite(line.data(), 1, line.size(), stderr);
}

void Console::clear_bar() {
  if (bar_width_ == 0) return;
  fmt::print(stderr, "\r{:{}}\r", "", bar_width_);
  std::fflush(stderr);
  bar_width_ = 0;
}

void Console::draw() {
  const std::uint64_t done = done_;
  const double seconds = std::chrono::duration<double>(Clock::now() - began_).count();
  if (draws_json_) {
    draw_json(done, seconds);
  } else if (draws_bar_) {
    draw_bar(done, seconds);
  }
}

void Console::draw_bar(std::uint64_t done, double seconds) {
  const double rate = seconds > 0 ? static_cast<double>(done) / seconds : 0;
  std::string line = stage_;
  if (total_ > 0) {
    const double part = std::min(1.0, static_cast<double>(done) / static_cast<double>(total_));
    constexpr std::size_t kCells = 24;
    const auto full = static_cast<std::size_t>(part * kCells);
    line += fmt::format(" [{:#<{}}{:.<{}}] {:3.0f} %", "", full, "", kCells - full, 100 * part);
  }
  line += fmt::format("  {}{}/s", amount_text(rate), unit_);
  if (total_ > done && rate > 0) {
    line += fmt::format("  ETA {}", duration_text(static_cast<double>(total_ - done) / rate));
  }
  line.resize(std::min(line.size(), screen_width()));
  const std::size_t width = std::max(line.size(), bar_width_);
  fmt::print(stderr, "\r{:{}}", line, width);
  std::fflush(stderr);
  bar_width_ = line.size();
}

void Console::draw_json(std::uint64_t done, double seconds) {
  // Stage and unit are names of ours and need no escapes.
  const std::string total = total_ > 0 ? fmt::format("{}", total_) : "null";
  fmt::print(stderr,
             "{{\"stage\":\"{}\",\"done\":{},\"total\":{},\"unit\":\"{}\",\"seconds\":{:.3f}}}\n",
             stage_, done, total, unit_, seconds);
}

}  // namespace mc::cli
